"""Marks of criteria over measures of the train."""

from __future__ import annotations

from collections.abc import Iterator

from uictest.core.units import STANDARD_GRAVITY
from uictest.judging import evaluation
from uictest.report.escaping import printable
from uictest.report.page.stop.mark import Mark, instant, limit_marks, point
from uictest.report.traces.moments import TRAIN, Moments
from uictest.report.traces.trace import PlotTrace
from uictest.report.wording import limits, number, quantity, value_and_limits


def braking_distance(verdict: evaluation.Verdict, trace: PlotTrace) -> Iterator[Mark]:
    """Yield the band of distances within the bounds and, unless it passed, the distance reached."""
    yield from _band(verdict, "over-distance")


def braking_time(verdict: evaluation.Verdict, trace: PlotTrace) -> Iterator[Mark]:
    """Yield the band of times within the bounds and, unless it passed, the time reached."""
    yield from _band(verdict, "speed")


def mean_deceleration(verdict: evaluation.Verdict, trace: PlotTrace) -> Iterator[Mark]:
    """Yield the bounds of the mean deceleration, and the mean over the whole stop."""
    yield from limit_marks(verdict, "deceleration", scale=STANDARD_GRAVITY)
    if verdict.value is not None:
        label = f"mean {quantity(verdict.value, verdict.unit)}"
        yield Mark("deceleration", "mean", label, y=verdict.value / STANDARD_GRAVITY)


def standstill(verdict: evaluation.Verdict, trace: PlotTrace) -> Iterator[Mark]:
    """Yield the end of a record in which the train does not come to a standstill."""
    if verdict.status != "pass":
        yield instant("speed", trace.end, f"{verdict.id}: the record ends at {_last_speed(trace)}")


def initial_adhesion(verdict: evaluation.Verdict, trace: PlotTrace) -> Iterator[Mark]:
    """Yield the first phase, the bounds in it and the mean deceleration over it."""
    duration = verdict.defined("first_phase_duration")
    if trace.sliding_time is None or duration is None:
        return
    start, end = trace.sliding_time, trace.sliding_time + duration
    yield Mark("speed", "window", f"first phase, {number(duration)} s", start, end)
    yield Mark("deceleration", "window", "", start, end)
    yield from limit_marks(verdict, "deceleration", x0=start, x1=end)
    if verdict.value is not None:
        label = f"mean {verdict.value:.4g} {verdict.unit}"
        yield Mark("deceleration", "mean", label, start, end, verdict.value)


def minimum_deceleration(verdict: evaluation.Verdict, trace: PlotTrace) -> Iterator[Mark]:
    """Yield the bounds of the smallest deceleration, and when it was that small."""
    yield from _extreme_deceleration(verdict, trace)


def maximum_deceleration(verdict: evaluation.Verdict, trace: PlotTrace) -> Iterator[Mark]:
    """Yield the bounds of the largest deceleration, and when it was that large."""
    yield from _extreme_deceleration(verdict, trace)


def reservoir_minimum_pressure(verdict: evaluation.Verdict, trace: PlotTrace) -> Iterator[Mark]:
    """Yield the bounds of the reservoir's pressure, and when it was lowest."""
    yield from limit_marks(verdict, "pressure")
    if (time := _decided_at(verdict, trace)) is not None and verdict.value is not None:
        yield point("pressure", time, verdict.value, f"lowest {quantity(verdict.value, verdict.unit)}")


def air_consumed(verdict: evaluation.Verdict, trace: PlotTrace) -> Iterator[Mark]:
    """Yield, unless it passed, the end of the stop, up to which the air was counted."""
    yield from _sum_at_the_end(verdict, trace, "pressure")


def air_residual(verdict: evaluation.Verdict, trace: PlotTrace) -> Iterator[Mark]:
    """Yield, unless it passed, the end of the stop, at which the balance of air is drawn up."""
    yield from _sum_at_the_end(verdict, trace, "pressure")


def air_energy_residual(verdict: evaluation.Verdict, trace: PlotTrace) -> Iterator[Mark]:
    """Yield, unless it passed, the end of the stop, at which the balance of the air's energy is drawn up."""
    yield from _sum_at_the_end(verdict, trace, "pressure")


def energy_residual(verdict: evaluation.Verdict, trace: PlotTrace) -> Iterator[Mark]:
    """Yield, unless it passed, the end of the stop, at which the balance of energy is drawn up."""
    yield from _sum_at_the_end(verdict, trace, "speed")


def _band(verdict: evaluation.Verdict, plot: str) -> Iterator[Mark]:
    label = printable(f"{verdict.id}: {limits(verdict, word='')}")
    yield Mark(plot, "band", label, verdict.lower, verdict.upper)
    if verdict.value is not None and verdict.status != "pass":
        yield instant(plot, verdict.value, quantity(verdict.value, verdict.unit))


def _sum_at_the_end(verdict: evaluation.Verdict, trace: PlotTrace, plot: str) -> Iterator[Mark]:
    if verdict.status != "pass":
        yield instant(plot, trace.end, f"{verdict.id}: {value_and_limits(verdict)}")


def _extreme_deceleration(verdict: evaluation.Verdict, trace: PlotTrace) -> Iterator[Mark]:
    yield from limit_marks(verdict, "deceleration", scale=STANDARD_GRAVITY)
    if (time := _decided_at(verdict, trace)) is not None and verdict.value is not None:
        label = quantity(verdict.value, verdict.unit)
        yield point("deceleration", time, verdict.value / STANDARD_GRAVITY, label)


def _decided_at(verdict: evaluation.Verdict, trace: PlotTrace) -> float | None:
    """Return when a measure of the train had the value of the criterion, s; None where it is not known."""
    moments = trace.moments.get(verdict.id, Moments())
    return moments.extremes[TRAIN][0] if TRAIN in moments.extremes else None


def _last_speed(trace: PlotTrace) -> str:
    curve = trace.curves.get("speed")
    return "an unknown speed" if curve is None else f"{curve.y[-1]:.3g} km/h"
