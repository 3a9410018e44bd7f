"""Timing of two things side by side: a neighbour's load falls on both, and less on their ratio."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from statistics import median

Call = Callable[[], object]
Clock = Callable[[], float]


@dataclass(frozen=True)
class Comparison:
    """Times in s of one call each, taken in turns."""

    ours: list[float]
    theirs: list[float]

    @property
    def ratio(self) -> float:
        """Median of ours over theirs, turn by turn."""
        return median(a / b for a, b in zip(self.ours, self.theirs, strict=True))


def seconds(call: Call, clock: Clock) -> float:
    """Return the time that one call takes."""
    begin = clock()
    call()
    return clock() - begin


def side_by_side(ours: Call, theirs: Call, turns: int, clock: Clock = time.thread_time) -> Comparison:
    """Time both ``turns`` times, each first in every other turn, after one call that is not counted.

    The clock counts what this thread computes; pass :func:`time.perf_counter` for processes.
    """
    ours()
    theirs()
    comparison = Comparison([], [])
    for turn in range(turns):
        if turn % 2:
            comparison.theirs.append(seconds(theirs, clock))
            comparison.ours.append(seconds(ours, clock))
        else:
            comparison.ours.append(seconds(ours, clock))
            comparison.theirs.append(seconds(theirs, clock))
    return comparison
