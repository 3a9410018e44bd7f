"""Where the plots of a stop show the value of a criterion: the instant or the time that decided it."""

from __future__ import annotations

from typing import NamedTuple

from uictest.core.measures import MEASURES, ShownWhen
from uictest.judging import evaluation
from uictest.report.traces.moments import TRAIN, Moments, duration
from uictest.report.traces.trace import PlotTrace


def shown_when(verdict: evaluation.Verdict) -> ShownWhen | None:
    """Return when a stop decides the measure of a criterion; None for what no moment of it decides."""
    measure = MEASURES.get(verdict.measure)
    return None if measure is None else measure.decided


class Taken(NamedTuple):
    """From `start` to `end`, s since the brake command, in the plot `plot`; one instant where both are equal.

    `wheelset` is the one that decides; None for a measure of the train. `value` is the height of the instant
    in the unit of the plot, None where there is none. `begun` is the time of the first sample that shows it,
    None for `start`: the first that counts as locked or sliding counts from the sample before it on.
    """

    plot: str
    start: float
    end: float
    wheelset: int | None = None
    value: float | None = None
    begun: float | None = None

    @property
    def seen(self) -> float:
        """The time at which a cursor shows it."""
        return self.start if self.begun is None else self.begun

    @property
    def text(self) -> str:
        """The instant or the stretch of time, and the wheelset."""
        return self.times + (f", wheelset {self.wheelset}" if self.wheelset else "")

    @property
    def times(self) -> str:
        """The instant or the stretch of time."""
        return f"{self.start:.4g} s" if self.start == self.end else f"{self.start:.4g} to {self.end:.4g} s"


def taken_at(verdict: evaluation.Verdict, trace: PlotTrace) -> Taken | None:
    """Return the instant at which the value of a criterion was taken; None where no plot shows it."""
    decided, moments = shown_when(verdict), trace.moments.get(verdict.id, Moments())
    if decided is None or verdict.value is None:
        return None
    if decided.how == "end":
        return Taken(decided.plot, trace.end, trace.end)
    if decided.how == "span":
        of_part = decided.span is not None or decided.down_to
        span = moments.span if of_part else (trace.start, trace.end)
        return None if span is None else Taken(decided.plot, *span)
    n = moments.wheelset
    if decided.how == "extreme":
        if (TRAIN if n is None else n) not in moments.extremes:
            return None
        time, height = moments.extremes[TRAIN if n is None else n]
        return Taken(decided.plot, time, time, n, height)
    if n is None and MEASURES[verdict.measure].of_wheelsets:
        return None
    intervals = [span for k, spans in moments.intervals.items() if n in (None, k) for span in spans]
    if not intervals:
        return None
    first, last = max(intervals, key=duration)
    if decided.how != "longest":
        first, last = min(intervals)[0], max(last for _, last in intervals)
    begun = None if decided.how == "outer" else first + trace.interval
    return Taken(decided.plot, first, last, n, begun=begun)
