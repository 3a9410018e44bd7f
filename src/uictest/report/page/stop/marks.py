"""Criteria as they are drawn into the plots: limits, and the instants and intervals that decided them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final, Literal, NamedTuple

from uictest.core.measures import MEASURES, ShownWhen
from uictest.core.units import SIZES, in_unit
from uictest.judging import evaluation
from uictest.report.escaping import printable
from uictest.report.page.stop.mark import Mark, instant, limit_marks, misses, point
from uictest.report.traces.moments import TRAIN, Moments, duration
from uictest.report.traces.quantities import PANELS, STRIPS
from uictest.report.traces.trace import PlotTrace
from uictest.report.verdict_sentences import failing_first, limits, number, quantity, value_and_limits

_UNITS: Final = {panel.key: panel.unit for panel in PANELS}
_STRIPS: Final = frozenset(strip.key for strip in STRIPS)
_PLOTS: Final = (*(panel.key for panel in PANELS), *(strip.key for strip in STRIPS))


def marks_of(verdicts: Iterable[evaluation.Verdict], trace: PlotTrace) -> list[Mark]:
    """Return the marks of every criterion that applied to a stop, those of failing ones first."""
    return [
        mark._replace(
            criterion=verdict.id,
            status=_status(verdict, mark.wheelset),
            # In words, not by its colour alone, where a criterion was not decided.
            label=f"{mark.label} (inconclusive)"
            if mark.label and verdict.status == "inconclusive"
            else mark.label,
        )
        for verdict in failing_first(verdicts)
        if verdict.status != "not_applicable" and (decided := _decided(verdict)) is not None
        for mark in _marks(verdict, decided, trace)
    ]


def _status(verdict: evaluation.Verdict, wheelset: int | None) -> evaluation.Status:
    """Return the verdict, of a wheelset that keeps what another one misses `pass`."""
    keeps = wheelset is not None and bool(verdict.missed_by) and wheelset not in verdict.missed_by
    return "pass" if keeps and verdict.status == "fail" else verdict.status


def fault_marks(trace: PlotTrace) -> Iterator[Mark]:
    """Yield the stretches in which faults were active, in every plot; the first one names them."""
    for span in trace.faults:
        for place, plot in enumerate(_PLOTS):
            yield Mark(plot, "fault", "" if place else f"fault: {span.label}", span.start, span.end)


def _decided(verdict: evaluation.Verdict) -> ShownWhen | None:
    measure = MEASURES.get(verdict.measure)
    return None if measure is None else measure.decided


def _marks(verdict: evaluation.Verdict, decided: ShownWhen, trace: PlotTrace) -> Iterator[Mark]:
    moments = trace.moments.get(verdict.id, Moments())
    if decided.across:
        yield from _band(verdict, decided)
    elif decided.how == "end":
        if verdict.status != "pass":
            what = f"{decided.word} {_last_speed(trace)}" if decided.word else value_and_limits(verdict)
            yield instant(decided.plot, trace.end, f"{verdict.id}: {what}")
    elif decided.how == "span":
        yield from _span(verdict, decided, moments)
    elif decided.how == "extreme":
        yield from _extremes(verdict, decided, moments)
    elif verdict.status != "pass" or decided.how != "outer":
        yield from _intervals(verdict, decided, moments)


def _band(verdict: evaluation.Verdict, decided: ShownWhen) -> Iterator[Mark]:
    """Yield what lies within the bounds of a distance or a time and, unless it passed, what was reached."""
    label = printable(f"{verdict.id}: {limits(verdict, word='')}")
    along: Literal["time", "distance"] = "distance" if decided.along_distance else "time"
    yield Mark(decided.across, "band", label, verdict.lower, verdict.upper, along=along)
    if verdict.value is not None and verdict.status != "pass":
        reached = instant(decided.across, verdict.value, quantity(verdict.value, verdict.unit))
        yield reached._replace(along=along)


def _span(verdict: evaluation.Verdict, decided: ShownWhen, moments: Moments) -> Iterator[Mark]:
    """Yield a mean with its bounds over its span; of another value, unless it passed, the span alone."""
    start, end = moments.span or (None, None)
    if (decided.span or decided.down_to) and (start is None or end is None):
        return
    if not decided.level:
        if verdict.status != "pass":
            label = printable(f"{verdict.id}: {value_and_limits(verdict)}")
            yield Mark(decided.plot, "window", label, start, end)
        return
    if start is not None and end is not None:
        yield Mark("speed", "window", f"{decided.span_name}, {number(end - start)} s", start, end)
        yield Mark(decided.plot, "window", "", start, end)
    scale = _scale(verdict, decided)
    yield from limit_marks(verdict, decided.plot, x0=start, x1=end, scale=scale)
    if verdict.value is not None:
        label = f"{decided.word} {quantity(verdict.value, verdict.unit)}"
        yield Mark(decided.plot, "mean", label, start, end, verdict.value / scale)


def _extremes(verdict: evaluation.Verdict, decided: ShownWhen, moments: Moments) -> Iterator[Mark]:
    """Yield the bounds, and the extreme of the train or, unless it passed, of each wheelset."""
    if decided.level:
        until = moments.span[1] if moments.span else None
        yield from limit_marks(verdict, decided.plot, x1=until, scale=_scale(verdict, decided))
    for n, (time, height) in moments.extremes.items():
        if n == TRAIN and verdict.value is not None:
            y = verdict.value / _scale(verdict, decided) if decided.level else height
            label = f"{decided.word} {quantity(verdict.value, verdict.unit)}".lstrip()
            yield point(decided.plot, time, y, label)
        elif n != TRAIN and verdict.status != "pass":
            label = f"{n}: {quantity(height, verdict.unit)}" if misses(verdict, height) else ""
            yield point(decided.plot, time, height, label, n)


def _intervals(verdict: evaluation.Verdict, decided: ShownWhen, moments: Moments) -> Iterator[Mark]:
    """Yield intervals in a strip; the longest of the wheelset that decides carries a value that did not pass.

    A panel has no room for more than the longest.
    """
    rows = [(last - first, first, last, n) for n, own in moments.intervals.items() for first, last in own]
    longest = max((row for row in rows if moments.wheelset in (None, row[3])), default=None)
    label = "" if verdict.status == "pass" else printable(f"{verdict.id}: {value_and_limits(verdict)}")
    if label and (moving_speed := verdict.defined("moving_speed")) is not None:
        label += f", above {quantity(in_unit(moving_speed, 'km/h'), 'km/h')}"
    for row in rows:
        _, first, last, n = row
        if decided.plot in _STRIPS:
            yield Mark(decided.plot, "interval", label if row == longest else "", first, last, float(n), n)
        elif label and row == longest:
            yield Mark(decided.plot, "window", label, first, last)


def _scale(verdict: evaluation.Verdict, decided: ShownWhen) -> float:
    """Return how many units of the criterion one unit of the plot is."""
    return SIZES.get(_UNITS[decided.plot], 1.0) / SIZES.get(verdict.unit, 1.0)


def _last_speed(trace: PlotTrace) -> str:
    curve = trace.curves.get("speed")
    return "an unknown speed" if curve is None else f"{curve.y[-1]:.3g} km/h"


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
    """Return where the value of a criterion was taken; None where the plots show no such place."""
    decided, moments = _decided(verdict), trace.moments.get(verdict.id, Moments())
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
        number_of_extreme = TRAIN if n is None else n
        if number_of_extreme not in moments.extremes:
            return None
        time, height = moments.extremes[number_of_extreme]
        return Taken(decided.plot, time, time, n, height)
    if n is None and MEASURES[verdict.measure].of_wheelsets:
        return None
    intervals = [each for k, own in moments.intervals.items() if n in (None, k) for each in own]
    if not intervals:
        return None
    first, last = max(intervals, key=duration)
    if decided.how != "longest":
        first, last = min(intervals)[0], max(last for _, last in intervals)
    begun = None if decided.how == "outer" else first + trace.interval
    return Taken(decided.plot, first, last, n, begun=begun)
