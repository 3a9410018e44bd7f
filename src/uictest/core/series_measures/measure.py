"""What declares a measure of a series: its value for each wet stop, and the statistic over them."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

from uictest.core.series_measures.estimate import Estimate, Statistic
from uictest.core.series_measures.stops import Figure, SpeedStops


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
