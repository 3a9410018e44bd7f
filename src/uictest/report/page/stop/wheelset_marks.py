"""Marks of criteria over measures of the wheelsets: where each wheelset decided, and which of them missed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from uictest.judging import evaluation
from uictest.report.escaping import printable
from uictest.report.page.stop.mark import Mark, limit_marks, misses, point, vents
from uictest.report.traces.moments import Interval, Moments
from uictest.report.traces.quantities import WHEELSETS
from uictest.report.traces.trace import PlotTrace
from uictest.report.wording import quantity, value_and_limits


def maximum_slide(verdict: evaluation.Verdict, trace: PlotTrace) -> Iterator[Mark]:
    """Yield the bounds down to the cut-off and, unless it passed, each wheelset's largest slide above it."""
    yield from limit_marks(verdict, "slide", x1=_moments(verdict, trace).until)
    yield from _largest(verdict, trace, "slide")


def maximum_clamping_force(verdict: evaluation.Verdict, trace: PlotTrace) -> Iterator[Mark]:
    """Yield the bounds and, unless it passed, the largest force of each wheelset."""
    yield from limit_marks(verdict, "force")
    yield from _largest(verdict, trace, "force")


def maximum_disc_temperature(verdict: evaluation.Verdict, trace: PlotTrace) -> Iterator[Mark]:
    """Yield the bounds and, unless it passed, the highest temperature of each wheelset's discs."""
    yield from limit_marks(verdict, "temperature")
    yield from _largest(verdict, trace, "temperature")


def locked(verdict: evaluation.Verdict, trace: PlotTrace) -> Iterator[Mark]:
    """Yield when each wheelset was locked."""
    yield from _intervals(verdict, "locked", _moments(verdict, trace).intervals)


def sliding(verdict: evaluation.Verdict, trace: PlotTrace) -> Iterator[Mark]:
    """Yield when each wheelset slid."""
    yield from _intervals(verdict, "sliding", _moments(verdict, trace).intervals)


def vented(verdict: evaluation.Verdict, trace: PlotTrace) -> Iterator[Mark]:
    """Yield, unless it passed, from the first to the last vent of each wheelset."""
    if verdict.status != "pass":
        spans = {n: [(bars[0][0], bars[-1][1])] for n in WHEELSETS if (bars := vents(trace, n))}
        yield from _intervals(verdict, "valves", spans)


def _moments(verdict: evaluation.Verdict, trace: PlotTrace) -> Moments:
    return trace.moments.get(verdict.id, Moments())


def _intervals(
    verdict: evaluation.Verdict, strip: str, intervals: Mapping[int, Sequence[Interval]]
) -> Iterator[Mark]:
    """Yield intervals in a strip; the longest carries the value, where the criterion did not pass."""
    rows = [(last - first, first, last, n) for n, own in intervals.items() for first, last in own]
    longest = max(rows, default=None)
    label = "" if verdict.status == "pass" else printable(f"{verdict.id}: {value_and_limits(verdict)}")
    for row in rows:
        _, first, last, n = row
        yield Mark(strip, "interval", label if row == longest else "", first, last, float(n), n)


def _largest(verdict: evaluation.Verdict, trace: PlotTrace, plot: str) -> Iterator[Mark]:
    if verdict.status != "pass":
        for n, (time, value) in _moments(verdict, trace).extremes.items():
            label = f"{n}: {quantity(value, verdict.unit)}" if misses(verdict, value) else ""
            yield point(plot, time, value, label, n)
