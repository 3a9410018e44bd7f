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
            largest and smallest: no interval, see `covered`.
        stops: how many were drawn.
        smallest, largest: of the stops, the spread.
        covered: for the largest (smallest) of the stops: share of all such stops that, with `confidence`,
            keep on its good side; NaN otherwise.

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

    def mapped(self, function: Callable[[float], float]) -> Estimate:
        """Return the estimate of a monotone function of the value."""
        low, high = sorted((function(self.low), function(self.high)))
        smallest, largest = sorted((function(self.smallest), function(self.largest)))
        value = function(self.value)
        return replace(self, value=value, low=low, high=high, smallest=smallest, largest=largest)


Statistic = Callable[[Sequence[float], float], Estimate]
"""Makes an estimate of the values of stops (at least one, all finite) and a confidence."""


def median_of(values: Sequence[float], confidence: float) -> Estimate:
    """Return the median with its interval by order statistics, whatever the distribution.

    95 % take at least six values.
    """
    ranks, ranked = statistics.bound_ranks(0.5, len(values), confidence, "both"), sorted(values)
    low = math.nan if ranks.lower is None else ranked[ranks.lower - 1]
    high = math.nan if ranks.upper is None else ranked[-ranks.upper]
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
    return _extreme(max(values), values, confidence, "largest")


def smallest_of(values: Sequence[float], confidence: float) -> Estimate:
    """Return the smallest value, and the share of all such stops that stays above it."""
    return _extreme(min(values), values, confidence, "smallest")


def _extreme(value: float, values: Sequence[float], confidence: float, method: Method) -> Estimate:
    # All n draws stay below the quantile of order q with probability q^n; with n = 50 q is 94.2 % for 95 %.
    covered = (1.0 - confidence) ** (1.0 / len(values))
    whole = _estimate(value, math.nan, math.nan, confidence, method, values)
    return replace(whole, covered=covered)


def _estimate(
    value: float, low: float, high: float, confidence: float, method: Method, values: Sequence[float]
) -> Estimate:
    return Estimate(value, low, high, confidence, method, len(values), min(values), max(values))


@dataclass(frozen=True, slots=True)
class CountedStop:
    """A stop that counts as a test: the columns of its result.

    Args:
        measures: column of stops -> number in the unit of the column, NaN where there is none.
        wheelsets: the same for every wheelset, from the leading end.
        passed: whether it meets every requirement on a stop.

    """

    measures: Mapping[str, float]
    wheelsets: tuple[Mapping[str, float], ...]
    passed: bool


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
        """Return the mean of a figure over the dry stops, the reference; NaN without any."""
        return math.fsum(map(figure, self.dry)) / len(self.dry) if self.dry else math.nan


def of_stop(column: str) -> Figure:
    """Return the figure that a column of stops holds."""
    return lambda stop: stop.measures.get(column, math.nan)


def largest_of_wheelsets(column: str) -> Figure:
    """Return the figure of the wheelset that has most of what a column of wheelsets holds."""

    def largest(stop: CountedStop) -> float:
        values = [wheelset.get(column, math.nan) for wheelset in stop.wheelsets]
        return math.nan if not values or any(map(math.isnan, values)) else max(values)

    return largest


@dataclass(frozen=True, slots=True)
class SeriesValue:
    """A measure of a series: an estimate, or why there is none."""

    estimate: Estimate | None = None
    unavailable_reason: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class SeriesMeasure:
    """One measure over the wet stops from one initial speed, or from all.

    Args:
        name: in criteria files and results.
        kind: of quantity that its bounds are, a key of :data:`uictest.core.units.KINDS`.
        unit: of its values.
        meaning: what it is, in words.
        worse: which of two values is the worse one. The value of a series is that of its worst speed.
        values: returns the number of every wet stop, NaN where a stop has none.
        statistic: makes the estimate of these.
        pooled: whether the value of the series is that of all its stops together instead.
        figure: what `values` reads of a stop, where it is one figure alone: a bound may then refer to the
            mean of the dry stops.

    """

    name: str
    kind: str
    unit: str
    meaning: str
    worse: Literal["larger", "smaller"]
    values: Callable[[SpeedStops], list[float]]
    statistic: Statistic
    pooled: bool = False
    figure: Figure | None = None

    def of_speed(self, stops: SpeedStops, confidence: float) -> SeriesValue:
        """Return the value over the wet stops from one speed."""
        return estimated(self.values(stops), self.statistic, confidence)

    def of_series(self, speeds: Sequence[SpeedStops], confidence: float) -> SeriesValue:
        """Return the value of a series: that of its worst speed, or that of all stops together."""
        if self.pooled:
            return estimated([v for each in speeds for v in self.values(each)], self.statistic, confidence)
        return self.worst([self.of_speed(each, confidence) for each in speeds])

    def worst(self, values: Sequence[SeriesValue]) -> SeriesValue:
        """Return the worst of some values; one that is not known could be worse than all others."""
        unknown = next((value for value in values if value.estimate is None), None)
        if unknown is not None or not values:
            return unknown or SeriesValue(unavailable_reason="no stop")
        sign = 1.0 if self.worse == "larger" else -1.0
        return max(values, key=lambda each: sign * (each.estimate.value if each.estimate else math.nan))


def estimated(values: Sequence[float], statistic: Statistic, confidence: float) -> SeriesValue:
    """Return the estimate of some values, or how many of them are missing."""
    if not values:
        return SeriesValue(unavailable_reason="no wet stop counts")
    missing = sum(not math.isfinite(value) for value in values)
    if missing:
        return SeriesValue(unavailable_reason=f"{missing} of {len(values)} wet stops have no such number")
    return SeriesValue(statistic(values, confidence))


def percent_of_dry(figure: Figure, stops: SpeedStops) -> list[float]:
    """Return a figure of every wet stop as a percentage of its mean over the dry stops of the same speed."""
    reference = stops.dry_mean(figure)
    return [100.0 * figure(stop) / reference if reference else float("nan") for stop in stops.wet]


def dry_relation(measure: SeriesMeasure, speeds: Sequence[SpeedStops], confidence: float) -> SeriesValue:
    """Return the value of a series in percent of the dry stops. Raises ValueError where it has no figure."""
    if measure.figure is None:
        raise ValueError(f"{measure.name!r} is no figure of single stops")
    figure = measure.figure

    def of_speed(stops: SpeedStops) -> SeriesValue:
        if not stops.dry:
            return SeriesValue(unavailable_reason="no dry stop counts")
        if not abs(stops.dry_mean(figure)) > 0.0:
            return SeriesValue(unavailable_reason="the dry stops have no such number, or zero")
        return estimated(percent_of_dry(figure, stops), measure.statistic, confidence)

    return measure.worst([of_speed(stops) for stops in speeds])


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
            values=lambda stops: [figure(stop) for stop in stops.wet],
            statistic=statistic,
            figure=figure,
        )
        for prefix, word, statistic in (("median", "median", median_of), ("worst", which, extreme))
    )
    return median, worst
