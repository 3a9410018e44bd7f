"""Criteria as they are drawn into the plots: limits, and the instants and intervals that decided them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import Final, Literal, NamedTuple

from uictest.core.measures import ShownWhen
from uictest.core.units import SIZES, in_unit
from uictest.judging import evaluation
from uictest.report.traces.instants import shown_when
from uictest.report.traces.moments import TRAIN, Moments
from uictest.report.traces.quantities import PANELS, STRIPS
from uictest.report.traces.trace import PlotTrace
from uictest.report.verdict_sentences import failing_first, limits, value_with_limit
from uictest.report.words import number, printable, quantity

_UNITS: Final = {panel.key: panel.unit for panel in PANELS}
_STRIPS: Final = [strip.key for strip in STRIPS]

Kind = Literal["limit", "mean", "window", "band", "tolerance", "instant", "point", "interval", "fault"]
Along = Literal["time", "distance"]


class Mark(NamedTuple):
    """A mark in a plot, in the units of the plot.

    limit, mean: a level line at `y` from `x0` to `x1`. window, band, fault: everything between `x0` and `x1`.
    None where it has no end. tolerance: everything from -`y` to `y`. instant: an upright line at `x0`.
    point: the place `x0`, `y`. interval: from `x0` to `x1` in row `y` of a strip. `wheelset` is None for a
    mark of all of them, or of the train. `along` is what `x0` and `x1` count: time, s, or distance, m.
    """

    plot: str
    kind: Kind
    label: str = ""
    x0: float | None = None
    x1: float | None = None
    y: float | None = None
    wheelset: int | None = None
    criterion: str = ""
    status: evaluation.Status = "pass"
    along: Along = "time"


def marks_of(verdicts: Iterable[evaluation.Verdict], trace: PlotTrace) -> list[Mark]:
    """Return the marks of every criterion that applied to a stop, those of failing ones first."""
    marks = []
    for verdict in failing_first(verdicts):
        decided = shown_when(verdict)
        if decided is None or verdict.status == "not_applicable":
            continue
        for mark in _verdict_marks(verdict, decided, trace):
            label = printable(mark.label)
            if label and verdict.status == "inconclusive":
                label += " (inconclusive)"  # in words, not by its colour alone
            # A wheelset keeps what another one misses.
            keeps = mark.wheelset is not None and verdict.missed_by and mark.wheelset not in verdict.missed_by
            status = "pass" if keeps and verdict.status == "fail" else verdict.status
            marks.append(mark._replace(criterion=verdict.id, status=status, label=label))
    return marks


def fault_marks(trace: PlotTrace) -> Iterator[Mark]:
    """Yield the stretches in which faults were active, in every plot; the first one names them."""
    for fault in trace.faults:
        for index, plot in enumerate([*_UNITS, *_STRIPS]):
            yield Mark(plot, "fault", "" if index else f"fault: {fault.label}", fault.start, fault.end)


def _verdict_marks(verdict: evaluation.Verdict, decided: ShownWhen, trace: PlotTrace) -> Iterator[Mark]:
    moments = trace.moments.get(verdict.id, Moments())
    if decided.across:
        yield from _band_marks(verdict, decided)
    elif decided.how == "end":
        if verdict.status != "pass":
            label = value_with_limit(verdict)
            if decided.word:
                speed = trace.curves.get("speed")
                label = f"{decided.word} {'an unknown speed' if speed is None else f'{speed.y[-1]:.3g} km/h'}"
            yield Mark(decided.plot, "instant", f"{verdict.id}: {label}", trace.end, trace.end)
    elif decided.how == "span":
        yield from _span_marks(verdict, decided, moments)
    elif decided.how == "extreme":
        yield from _extreme_marks(verdict, decided, moments)
    elif verdict.status != "pass" or decided.how != "outer":
        yield from _interval_marks(verdict, decided, moments)


def _band_marks(verdict: evaluation.Verdict, decided: ShownWhen) -> Iterator[Mark]:
    """Yield the band within the bounds of a distance or a time and, unless it passed, the value reached."""
    along: Along = "distance" if decided.along_distance else "time"
    label = f"{verdict.id}: {limits(verdict)}"
    yield Mark(decided.across, "band", label, verdict.lower, verdict.upper, along=along)
    if (value := verdict.value) is not None and verdict.status != "pass":
        yield Mark(decided.across, "instant", quantity(value, verdict.unit), value, value, along=along)


def _span_marks(verdict: evaluation.Verdict, decided: ShownWhen, moments: Moments) -> Iterator[Mark]:
    """Yield a mean with its bounds over its span; of another value, unless it passed, the span alone."""
    start, end = moments.span or (None, None)
    if (decided.span or decided.down_to) and (start is None or end is None):
        return
    if not decided.level:
        if verdict.status != "pass":
            label = f"{verdict.id}: {value_with_limit(verdict)}"
            yield Mark(decided.plot, "window", label, start, end)
        return
    if start is not None and end is not None:
        yield Mark("speed", "window", f"{decided.span_name}, {number(end - start)} s", start, end)
        yield Mark(decided.plot, "window", "", start, end)
    yield from _limit_marks(verdict, decided.plot, start, end)
    if verdict.value is not None:
        label = f"{decided.word} {quantity(verdict.value, verdict.unit)}"
        yield Mark(
            decided.plot,
            "mean",
            label,
            start,
            end,
            verdict.value / _units_per_plot_unit(verdict, decided.plot),
        )


def _extreme_marks(verdict: evaluation.Verdict, decided: ShownWhen, moments: Moments) -> Iterator[Mark]:
    """Yield the bounds, and the extreme of the train or, unless it passed, of each wheelset."""
    plot = decided.plot
    if decided.level:
        yield from _limit_marks(verdict, plot, None, moments.span[1] if moments.span else None)
    for n, (time, height) in moments.extremes.items():
        if n == TRAIN and verdict.value is not None:
            y = verdict.value / _units_per_plot_unit(verdict, plot) if decided.level else height
            label = f"{decided.word} {quantity(verdict.value, verdict.unit)}".lstrip()
            yield Mark(plot, "point", label, time, time, y)
        elif n != TRAIN and verdict.status != "pass":
            label = f"{n}: {quantity(height, verdict.unit)}" if _misses(verdict, height) else ""
            yield Mark(plot, "point", label, time, time, height, n)


def _misses(verdict: evaluation.Verdict, value: float) -> bool:
    """Return whether a value, in the unit of the criterion, misses its bounds.

    A criterion that fails with a margin of 0 is one whose bounds themselves do not pass.
    """
    strict = verdict.status == "fail" and verdict.margin == 0.0
    margins = []
    if verdict.lower is not None:
        margins.append(value - verdict.lower)
    if verdict.upper is not None:
        margins.append(verdict.upper - value)
    return any(margin < 0.0 or (strict and margin == 0.0) for margin in margins)


def _interval_marks(verdict: evaluation.Verdict, decided: ShownWhen, moments: Moments) -> Iterator[Mark]:
    """Yield intervals in a strip; the longest of the wheelset that decides carries a value that did not pass.

    A panel has no room for more than the longest.
    """
    intervals = [
        (last - first, first, last, n) for n, spans in moments.intervals.items() for first, last in spans
    ]
    of_deciding = [interval for interval in intervals if moments.wheelset in (None, interval[3])]
    longest = max(of_deciding, default=None)
    label = "" if verdict.status == "pass" else f"{verdict.id}: {value_with_limit(verdict)}"
    if label and (moving_speed := verdict.defined("moving_speed")) is not None:
        label += f", above {quantity(in_unit(moving_speed, 'km/h'), 'km/h')}"
    for interval in intervals:
        _, first, last, n = interval
        own_label = label if interval == longest else ""
        if decided.plot in _STRIPS:
            yield Mark(decided.plot, "interval", own_label, first, last, float(n), n)
        elif own_label:
            yield Mark(decided.plot, "window", own_label, first, last)


def _limit_marks(
    verdict: evaluation.Verdict, plot: str, start: float | None, end: float | None
) -> Iterator[Mark]:
    """Yield the bounds of a criterion as level lines."""
    for bound in (verdict.lower, verdict.upper):
        if bound is not None and math.isfinite(bound):
            label = f"limit {quantity(bound, verdict.unit)}"
            yield Mark(plot, "limit", label, start, end, bound / _units_per_plot_unit(verdict, plot))


def _units_per_plot_unit(verdict: evaluation.Verdict, plot: str) -> float:
    """Return the number of units of the criterion in one unit of the plot."""
    return SIZES.get(_UNITS[plot], 1.0) / SIZES.get(verdict.unit, 1.0)
