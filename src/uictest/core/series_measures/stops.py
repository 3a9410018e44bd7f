"""The stops of a series that count: their figures, sorted by initial speed and rail."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Literal


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
