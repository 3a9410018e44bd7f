"""What declares a measure of a series, the stops that count, and what they say of all stops like them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from statistics import median
from typing import Literal

from uictest.core import statistics

Method = Literal["median", "mean", "share", "largest", "smallest"]
"""How a value was made of those of the stops, and with it how its interval was."""


@dataclass(frozen=True, slots=True)
class Estimate:
    """A value over stops.

    Args:
        value: the estimate.
        low, high: the interval that holds the true one with `confidence`; NaN where there is none.
        confidence: of the interval, a share.
        method: median: interval by order statistics; mean: by Student's t; share: by Clopper and Pearson;
            largest and smallest: no interval, see `covered`. Over dry stops see :func:`over_dry`.
        stops: how many were drawn.
        smallest, largest: of the stops, the spread.
        covered: for the largest (smallest) of the stops: share of all such stops that, with `confidence`,
            keep on its good side; over dry stops on that of `high` (`low`). NaN otherwise.
        dry_stops: over the mean of how many the value is; 0 where it does not refer to them.
        dry_scatter: whether these show how they scatter; there is neither an interval nor a cover otherwise.

    """

    value: float
    low: float
    high: float
    confidence: float
    method: Method
    stops: int
    smallest: float
    largest: float
    covered: float = math.nan
    dry_stops: int = 0
    dry_scatter: bool = True

    def mapped(self, function: Callable[[float], float]) -> Estimate:
        """Return the estimate of a monotone function of the value."""
        ends = self.low, self.high
        low, high = sorted(math.nan if math.isnan(end) else function(end) for end in ends)
        smallest, largest = sorted((function(self.smallest), function(self.largest)))
        value = function(self.value)
        return replace(self, value=value, low=low, high=high, smallest=smallest, largest=largest)


_FEWEST_EQUAL = 5
"""Dry stops from which equal ones are known to scatter by nothing; a few may be equal by rounding; chosen."""
Statistic = Callable[[Sequence[float], float], Estimate]
"""Makes an estimate of the values of stops (at least one, all finite) and a confidence."""


def median_of(values: Sequence[float], confidence: float) -> Estimate:
    """Return the median with its interval by order statistics, whatever the distribution.

    95 % take at least six values.
    """
    rank, ranked = statistics.median_rank(len(values), confidence), sorted(values)
    low, high = (math.nan, math.nan) if rank is None else (ranked[rank - 1], ranked[-rank])
    return _estimate(median(values), low, high, confidence, "median", values)


def mean_of(values: Sequence[float], confidence: float) -> Estimate:
    """Return the mean with its interval by Student's t."""
    low, high = statistics.mean_interval(values, confidence)
    return _estimate(math.fsum(values) / len(values), low, high, confidence, "mean", values)


def share_of(values: Sequence[float], confidence: float) -> Estimate:
    """Return the share (%) of values that are 1, the others 0, with its interval by Clopper and Pearson."""
    successes = sum(value == 1.0 for value in values)
    low, high = statistics.proportion_interval(successes, len(values), confidence)
    shares = [100.0 * value for value in values]
    share = 100.0 * successes / len(values)
    return _estimate(share, 100.0 * low, 100.0 * high, confidence, "share", shares)


def largest_of(values: Sequence[float], confidence: float) -> Estimate:
    """Return the largest value, and the share of all such stops that stays below it."""
    return _extreme_estimate(max(values), values, confidence, "largest")


def smallest_of(values: Sequence[float], confidence: float) -> Estimate:
    """Return the smallest value, and the share of all such stops that stays above it."""
    return _extreme_estimate(min(values), values, confidence, "smallest")


def _extreme_estimate(value: float, values: Sequence[float], confidence: float, method: Method) -> Estimate:
    whole = _estimate(value, math.nan, math.nan, confidence, method, values)
    return replace(whole, covered=_covered_share(len(values), confidence))


def _covered_share(stops: int, confidence: float) -> float:
    # All n draws stay below the quantile of order q with probability q^n; with n = 50 q is 94.2 % for 95 %.
    return float((1.0 - confidence) ** (1.0 / stops))


def _estimate(
    value: float, low: float, high: float, confidence: float, method: Method, values: Sequence[float]
) -> Estimate:
    return Estimate(value, low, high, confidence, method, len(values), min(values), max(values))


@dataclass(frozen=True, slots=True)
class SeriesValue:
    """A measure of a series: an estimate, or the reason for which there is none."""

    estimate: Estimate | None = None
    unavailable_reason: str = ""


def estimated(values: Sequence[float], statistic: Statistic, confidence: float) -> SeriesValue:
    """Return the estimate of some values, or how many of them are missing."""
    if not values:
        return SeriesValue(unavailable_reason="no wet stop counts")
    missing = sum(not math.isfinite(value) for value in values)
    if missing:
        return SeriesValue(unavailable_reason=f"{missing} of {len(values)} wet stops have no such number")
    return SeriesValue(statistic(values, confidence))


def over_dry(estimate: Estimate, dry: Sequence[float]) -> Estimate:
    """Return an estimate over the mean of dry stops, above zero, as a ratio with the scatter of both.

    The interval is that of :func:`uictest.core.statistics.ratio_interval`. Of the largest (smallest) value
    it is the value over both ends of that of the mean, and the covered share holds for `high` (`low`); what
    may fail is halved between both (Bonferroni). Dry stops that show no scatter make neither.
    """
    mean = mean_of(dry, estimate.confidence)
    ratio = replace(estimate.mapped(lambda value: value / mean.value), dry_stops=len(dry))
    if len(dry) < _FEWEST_EQUAL and min(dry) == max(dry):
        return replace(ratio, low=math.nan, high=math.nan, covered=math.nan, dry_scatter=False)
    if estimate.method not in ("largest", "smallest"):
        ends, half_width = (estimate.low, estimate.high), mean.high - mean.value
        low, high = statistics.ratio_interval(estimate.value, ends, mean.value, half_width)
        return replace(ratio, low=low, high=high)
    if not mean.low > 0.0:
        return replace(ratio, covered=math.nan)
    covered = _covered_share(estimate.stops, 0.5 + 0.5 * estimate.confidence)
    low, high = sorted((estimate.value / mean.low, estimate.value / mean.high))
    return replace(ratio, covered=covered, low=low, high=high)


@dataclass(frozen=True, slots=True)
class CountedStop:
    """A stop that counts as a test: the columns of its result.

    Args:
        measures: column of stops -> number in the unit of the column, NaN where there is none.
        wheelsets: the same for every wheelset, from the leading end.
        passed: whether it meets every requirement on a stop; None where one was left open.

    """

    measures: Mapping[str, float]
    wheelsets: tuple[Mapping[str, float], ...]
    passed: bool | None


Rail = Literal["", "cleaned", "uncleaned"]
"""Whether sliding cleans the rail of a simulated wet stop; empty for a dry or a recorded one."""

Figure = Callable[[CountedStop], float]
"""Reads one number of a stop, NaN where it has none."""


@dataclass(frozen=True, slots=True)
class SpeedStops:
    """The stops of a series from one nominal initial speed (m/s), on one kind of rail, that count.

    `rail` names the kind where a series has several: wet stops on different ones are not pooled.
    """

    speed: float
    dry: tuple[CountedStop, ...]
    wet: tuple[CountedStop, ...]
    rail: Rail = ""

    def dry_mean(self, figure: Figure) -> float:
        """Return the mean of a figure over the dry stops, the reference; NaN without any above zero."""
        mean = math.fsum(map(figure, self.dry)) / len(self.dry) if self.dry else math.nan
        # No share of a figure that is negative says which of two is the worse one.
        return mean if 0.0 < mean < math.inf else math.nan


def of_stop(column: str) -> Figure:
    """Return the figure that a column of stops holds."""
    return lambda stop: stop.measures.get(column, math.nan)


def largest_of_wheelsets(column: str) -> Figure:
    """Return the figure of the wheelset that has most of what a column of wheelsets holds."""

    def largest(stop: CountedStop) -> float:
        values = [wheelset.get(column, math.nan) for wheelset in stop.wheelsets]
        return math.nan if not values or any(map(math.isnan, values)) else max(values)

    return largest


@dataclass(frozen=True, slots=True, kw_only=True)
class SeriesMeasure:
    """One measure over the wet stops from one initial speed, or from all.

    Args:
        name: in criteria files and results.
        kind: of quantity that its bounds are, a key of :data:`uictest.core.units.KINDS`.
        unit: of its values.
        meaning: what it is, in words.
        worse: which of two values is the worse one. The value of a series is that of its worst speed.
        figure: of every wet stop.
        statistic: makes the estimate of these.
        pooled: whether it is of the stops from all speeds together instead; those on different kinds of rail
            are never pooled, and the value of the series is that of its worst rail then.
        of_ratio: makes the value of the ratio of the estimate to the mean of the dry stops; None where the
            value is the estimate itself.

    """

    name: str
    kind: str
    unit: str
    meaning: str
    worse: Literal["larger", "smaller"]
    figure: Figure
    statistic: Statistic
    pooled: bool = False
    of_ratio: Callable[[Estimate], Estimate] | None = None

    @property
    def has_dry_value(self) -> bool:
        """Whether it has a value of the dry stops too, to which a bound may refer."""
        return not self.pooled and self.of_ratio is None

    def of_speed(self, stops: SpeedStops, confidence: float) -> SeriesValue:
        """Return the value over the wet stops from one speed."""
        if self.of_ratio is not None:
            return self._ratio_to_dry(stops, confidence, self.of_ratio)
        return self._of_stops(stops.wet, confidence)

    def groups(self, speeds: Sequence[SpeedStops]) -> list[list[SpeedStops]]:
        """Return the groups of stops that make one value: from one speed, or on one rail if it is pooled."""
        if not self.pooled:
            return [[stops] for stops in speeds]
        rails = dict.fromkeys(stops.rail for stops in speeds)
        return [[stops for stops in speeds if stops.rail == rail] for rail in rails]

    def of_series(self, speeds: Sequence[SpeedStops], confidence: float) -> SeriesValue:
        """Return the value of a series: that of its worst speed, or that of its worst rail."""
        if not self.pooled:
            return self._worst_value([self.of_speed(stops, confidence) for stops in speeds])
        wet = ([stop for stops in group for stop in stops.wet] for group in self.groups(speeds))
        return self._worst_value([self._of_stops(stops, confidence) for stops in wet])

    def percent_of_dry(self, speeds: Sequence[SpeedStops], confidence: float) -> SeriesValue:
        """Return the value of a series in % of the dry stops. Raises ValueError without a dry value."""
        if not self.has_dry_value:
            raise ValueError(f"{self.name!r} has no value of the dry stops")
        return self._worst_value([self._ratio_to_dry(stops, confidence, _in_percent) for stops in speeds])

    def _of_stops(self, stops: Sequence[CountedStop], confidence: float) -> SeriesValue:
        return estimated([self.figure(stop) for stop in stops], self.statistic, confidence)

    def _ratio_to_dry(
        self, stops: SpeedStops, confidence: float, of_ratio: Callable[[Estimate], Estimate]
    ) -> SeriesValue:
        dry = [self.figure(stop) for stop in stops.dry]
        if not dry:
            return SeriesValue(unavailable_reason="no dry stop counts")
        if math.isnan(stops.dry_mean(self.figure)):
            return SeriesValue(unavailable_reason="the dry stops have no such number above zero")
        wet = self._of_stops(stops.wet, confidence)
        if wet.estimate is None:
            return wet
        value = of_ratio(over_dry(wet.estimate, dry))
        if math.isfinite(value.value):
            return SeriesValue(value)
        return SeriesValue(unavailable_reason="the wet stops have no such number above zero")

    def _worst_value(self, values: Sequence[SeriesValue]) -> SeriesValue:
        """Return the worst of some values; one that is not known could be worse than all others."""
        unknown = next((value for value in values if value.estimate is None), None)
        if unknown is not None or not values:
            return unknown or SeriesValue(unavailable_reason="no stop")
        sign = 1.0 if self.worse == "larger" else -1.0
        return max(values, key=lambda value: sign * (value.estimate.value if value.estimate else math.nan))


def _in_percent(ratio: Estimate) -> Estimate:
    return ratio.mapped(lambda value: 100.0 * value)


def median_and_worst(
    name: str,
    kind: str,
    unit: str,
    meaning: str,
    figure: Figure,
    worse: Literal["larger", "smaller"] = "larger",
) -> tuple[SeriesMeasure, SeriesMeasure]:
    """Return `median_NAME` and `worst_NAME` of a figure, which `meaning` describes."""
    which, extreme = ("largest", largest_of) if worse == "larger" else ("smallest", smallest_of)
    median, worst = (
        SeriesMeasure(
            name=f"{prefix}_{name}",
            kind=kind,
            unit=unit,
            meaning=f"{word} of the wet stops: {meaning}",
            worse=worse,
            figure=figure,
            statistic=statistic,
        )
        for prefix, word, statistic in (("median", "median", median_of), ("worst", which, extreme))
    )
    return median, worst
