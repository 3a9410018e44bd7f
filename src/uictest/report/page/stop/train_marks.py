"""Marks of criteria over measures of the train."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from uictest import evaluation
from uictest.report.escaping import printable
from uictest.report.page.stop.mark import Mark, instant, limit_marks, point
from uictest.report.wording import limits, number, quantity, value_and_limits
from uictest.units import KILOMETRE_PER_HOUR, STANDARD_GRAVITY

if TYPE_CHECKING:
    from uictest.report.traces.trace import Curve, Series, Trace


def braking_distance(verdict: evaluation.Verdict, trace: Trace) -> Iterator[Mark]:
    """Yield the band of distances within the bounds and, unless it passed, the distance reached."""
    yield from _band(verdict, "over-distance")


def braking_time(verdict: evaluation.Verdict, trace: Trace) -> Iterator[Mark]:
    """Yield the band of times within the bounds and, unless it passed, the time reached."""
    yield from _band(verdict, "speed")


def mean_deceleration(verdict: evaluation.Verdict, trace: Trace) -> Iterator[Mark]:
    """Yield the bounds of the mean deceleration, and the mean over the whole stop."""
    yield from limit_marks(verdict, "deceleration", scale=STANDARD_GRAVITY)
    if verdict.value is not None:
        label = f"mean {quantity(verdict.value, verdict.unit)}"
        yield Mark("deceleration", "found", label, y=verdict.value / STANDARD_GRAVITY)


def standstill(verdict: evaluation.Verdict, trace: Trace) -> Iterator[Mark]:
    """Yield the end of a record in which the train does not come to a standstill."""
    if verdict.verdict != "pass":
        yield instant("speed", trace.end, f"{verdict.id}: the record ends at {_last_speed(trace)}")


def initial_adhesion(verdict: evaluation.Verdict, trace: Trace) -> Iterator[Mark]:
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
        yield Mark("deceleration", "found", label, start, end, verdict.value)


def minimum_deceleration(verdict: evaluation.Verdict, trace: Trace) -> Iterator[Mark]:
    """Yield the bounds of the smallest deceleration, and when it was that small."""
    yield from _extreme_deceleration(verdict, trace, verdict.defined("developed_time") or 0.0, -1.0)


def maximum_deceleration(verdict: evaluation.Verdict, trace: Trace) -> Iterator[Mark]:
    """Yield the bounds of the largest deceleration, and when it was that large."""
    yield from _extreme_deceleration(verdict, trace, 0.0, 1.0)


def reservoir_minimum_pressure(verdict: evaluation.Verdict, trace: Trace) -> Iterator[Mark]:
    """Yield the bounds of the reservoir's pressure, and when it was lowest."""
    yield from limit_marks(verdict, "pressure")
    curve = trace.curves.get("reservoir_pressure")
    if curve is not None and verdict.value is not None:
        lowest = float(curve.x[np.nanargmin(curve.y)])
        yield point("pressure", lowest, verdict.value, f"lowest {quantity(verdict.value, verdict.unit)}")


def air_consumed(verdict: evaluation.Verdict, trace: Trace) -> Iterator[Mark]:
    """Yield, unless it passed, the end of the stop, up to which the air was counted."""
    yield from _sum_at_the_end(verdict, trace, "pressure")


def air_residual(verdict: evaluation.Verdict, trace: Trace) -> Iterator[Mark]:
    """Yield, unless it passed, the end of the stop, at which the balance of air is drawn up."""
    yield from _sum_at_the_end(verdict, trace, "pressure")


def energy_residual(verdict: evaluation.Verdict, trace: Trace) -> Iterator[Mark]:
    """Yield, unless it passed, the end of the stop, at which the balance of energy is drawn up."""
    yield from _sum_at_the_end(verdict, trace, "speed")


def _band(verdict: evaluation.Verdict, plot: str) -> Iterator[Mark]:
    label = printable(f"{verdict.id}: {limits(verdict).removeprefix('limits ')}")
    yield Mark(plot, "band", label, verdict.lower, verdict.upper)
    if verdict.value is not None and verdict.verdict != "pass":
        yield instant(plot, verdict.value, quantity(verdict.value, verdict.unit))


def _sum_at_the_end(verdict: evaluation.Verdict, trace: Trace, plot: str) -> Iterator[Mark]:
    if verdict.verdict != "pass":
        yield instant(plot, trace.end, f"{verdict.id}: {value_and_limits(verdict)}")


def _extreme_deceleration(
    verdict: evaluation.Verdict, trace: Trace, since: float, sign: float
) -> Iterator[Mark]:
    yield from limit_marks(verdict, "deceleration", scale=STANDARD_GRAVITY)
    curve, time_constant = trace.curves.get("speed"), verdict.defined("deceleration_filter")
    if curve is None or time_constant is None or verdict.value is None:
        return
    slowest = (verdict.defined("moving_speed") or 0.0) / KILOMETRE_PER_HOUR
    counts = (curve.y >= slowest) & (curve.x >= since)
    if counts.any():
        filtered = np.where(counts, sign * _filtered(curve, time_constant), -np.inf)
        label = quantity(verdict.value, verdict.unit)
        yield point(
            "deceleration", float(curve.x[np.nanargmax(filtered)]), verdict.value / STANDARD_GRAVITY, label
        )


def _filtered(curve: Curve, time_constant: float) -> Series:
    """Return the deceleration of a speed (km/h) after the low-pass of the measures, m/s2."""
    intervals, changes = np.diff(curve.x), -np.diff(curve.y * KILOMETRE_PER_HOUR)
    filtered = np.zeros_like(curve.x)
    for k, (interval, change) in enumerate(zip(intervals.tolist(), changes.tolist(), strict=True)):
        share = interval / (interval + time_constant)
        filtered[k + 1] = filtered[k] + share * (change / interval - filtered[k])
    return filtered


def _last_speed(trace: Trace) -> str:
    curve = trace.curves.get("speed")
    return "an unknown speed" if curve is None else f"{curve.y[-1]:.3g} km/h"
