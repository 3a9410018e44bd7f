"""What declares a measure of a series, and the stops that count."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from uictest.core.series_measures.estimate import (
    Estimate,
    SeriesValue,
    Statistic,
    estimated,
    largest_of,
    median_of,
    over_dry,
    smallest_of,
)


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
            return self._over_dry(stops, confidence, self.of_ratio)
        return self._of_stops(stops.wet, confidence)

    def groups(self, speeds: Sequence[SpeedStops]) -> list[list[SpeedStops]]:
        """Return which stops make one value: those from one speed, or on one rail if it is pooled."""
        if not self.pooled:
            return [[each] for each in speeds]
        rails = dict.fromkeys(each.rail for each in speeds)
        return [[each for each in speeds if each.rail == rail] for rail in rails]

    def of_series(self, speeds: Sequence[SpeedStops], confidence: float) -> SeriesValue:
        """Return the value of a series: that of its worst speed, or that of its worst rail."""
        if not self.pooled:
            return self._worst([self.of_speed(each, confidence) for each in speeds])
        together = ([stop for each in group for stop in each.wet] for group in self.groups(speeds))
        return self._worst([self._of_stops(stops, confidence) for stops in together])

    def percent_of_dry(self, speeds: Sequence[SpeedStops], confidence: float) -> SeriesValue:
        """Return the value of a series in % of the dry stops. Raises ValueError without a dry value."""
        if not self.has_dry_value:
            raise ValueError(f"{self.name!r} has no value of the dry stops")
        return self._worst([self._over_dry(stops, confidence, _in_percent) for stops in speeds])

    def _of_stops(self, stops: Sequence[CountedStop], confidence: float) -> SeriesValue:
        return estimated([self.figure(stop) for stop in stops], self.statistic, confidence)

    def _over_dry(
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

    def _worst(self, values: Sequence[SeriesValue]) -> SeriesValue:
        """Return the worst of some values; one that is not known could be worse than all others."""
        unknown = next((value for value in values if value.estimate is None), None)
        if unknown is not None or not values:
            return unknown or SeriesValue(unavailable_reason="no stop")
        sign = 1.0 if self.worse == "larger" else -1.0
        return max(values, key=lambda each: sign * (each.estimate.value if each.estimate else math.nan))


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
