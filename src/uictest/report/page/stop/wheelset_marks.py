"""Marks of criteria over measures of the wheelsets: where each wheelset decided, and which of them missed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from uictest import evaluation
from uictest.report.escaping import printable
from uictest.report.page.stop.bars import vents
from uictest.report.page.stop.mark import Mark, limit_marks, misses, point
from uictest.report.traces.quantities import WHEELSETS
from uictest.report.wording import quantity, value_and_limits
from uictest.units import KILOMETRE_PER_HOUR

if TYPE_CHECKING:
    from uictest.report.traces.trace import Curve, Trace

Interval = tuple[float, float]
Samples = NDArray[np.float64]


def maximum_slide(verdict: evaluation.Verdict, trace: Trace) -> Iterator[Mark]:
    """Yield the bounds down to the cut-off and, unless it passed, each wheelset's largest slide above it."""
    cutoff, speed = verdict.defined("low_speed_cutoff"), trace.curves.get("speed")
    until = None if cutoff is None or speed is None else _slower_than(cutoff / KILOMETRE_PER_HOUR, speed)
    yield from limit_marks(verdict, "slide", x1=until)
    yield from _largest(verdict, trace, "slide", "slide", trace.end if until is None else until)


def maximum_clamping_force(verdict: evaluation.Verdict, trace: Trace) -> Iterator[Mark]:
    """Yield the bounds and, unless it passed, the largest force of each wheelset."""
    yield from limit_marks(verdict, "force")
    yield from _largest(verdict, trace, "clamping_force", "force", trace.end)


def locked(verdict: evaluation.Verdict, trace: Trace) -> Iterator[Mark]:
    """Yield when each wheelset was locked."""
    yield from _intervals(verdict, "locked", {n: locks(verdict, trace, n) for n in WHEELSETS})


def sliding(verdict: evaluation.Verdict, trace: Trace) -> Iterator[Mark]:
    """Yield when each wheelset slid."""
    yield from _intervals(verdict, "sliding", {n: slides(verdict, trace, n) for n in WHEELSETS})


def vented(verdict: evaluation.Verdict, trace: Trace) -> Iterator[Mark]:
    """Yield, unless it passed, from the first to the last vent of each wheelset."""
    if verdict.verdict != "pass":
        spans = {n: [(bars[0][0], bars[-1][1])] for n in WHEELSETS if (bars := vents(trace, n))}
        yield from _intervals(verdict, "valves", spans)


def locks(verdict: evaluation.Verdict, trace: Trace, n: int) -> list[Interval]:
    """Return when a wheelset was locked while the train moved, by the definitions of the verdict."""
    locked, moving = verdict.defined("locked_speed"), verdict.defined("moving_speed")
    pair = _speeds(trace, n)
    if pair is None or locked is None or moving is None:
        return []
    time, speed, wheel_speed = pair
    return _runs(time, (speed > moving / KILOMETRE_PER_HOUR) & (wheel_speed < locked / KILOMETRE_PER_HOUR))


def slides(verdict: evaluation.Verdict, trace: Trace, n: int) -> list[Interval]:
    """Return when a wheelset slid while the train moved, by the definitions of the verdict."""
    share, slip, moving = map(verdict.defined, ("sliding_slide", "sliding_slip", "moving_speed"))
    pair = _speeds(trace, n)
    if pair is None or share is None or slip is None or moving is None:
        return []
    time, speed, wheel_speed = pair
    behind = speed - wheel_speed
    return _runs(
        time,
        (speed > moving / KILOMETRE_PER_HOUR)
        & (behind > share * speed)
        & (behind > slip / KILOMETRE_PER_HOUR),
    )


def _speeds(trace: Trace, n: int) -> tuple[Samples, Samples, Samples] | None:
    """Return time (s), train speed and wheel speed (km/h) at the points drawn of the wheel speed."""
    train, wheel = trace.curves.get("speed"), trace.curves.get(f"wheel_speed_{n}")
    if train is None or wheel is None:
        return None
    return wheel.x, np.interp(wheel.x, train.x, train.y), wheel.y


def _runs(time: Samples, holds: NDArray[np.bool_]) -> list[Interval]:
    """Return the intervals from the sample before each run to its last, as the measures count them."""
    ends = np.flatnonzero(np.diff(holds, prepend=False, append=False))
    return [(float(time[max(a - 1, 0)]), float(time[b - 1])) for a, b in ends.reshape(-1, 2).tolist()]


def _intervals(
    verdict: evaluation.Verdict, strip: str, intervals: Mapping[int, Sequence[Interval]]
) -> Iterator[Mark]:
    """Yield intervals in a strip; the longest carries the value, where the criterion did not pass."""
    every = [(last - first, first, last, n) for n, each in intervals.items() for first, last in each]
    longest = max(every, default=None)
    label = "" if verdict.verdict == "pass" else printable(f"{verdict.id}: {value_and_limits(verdict)}")
    for each in every:
        _, first, last, n = each
        yield Mark(strip, "interval", label if each == longest else "", first, last, float(n))


def _largest(verdict: evaluation.Verdict, trace: Trace, name: str, plot: str, until: float) -> Iterator[Mark]:
    for n in WHEELSETS if verdict.verdict != "pass" else ():
        curve = trace.curves.get(f"{name}_{n}")
        if curve is None or not (counted := np.isfinite(curve.y) & (curve.x <= until)).any():
            continue
        row = int(np.argmax(np.where(counted, curve.y, -np.inf)))
        x, y = float(curve.x[row]), float(curve.y[row])
        yield point(plot, x, y, f"{n}: {quantity(y, verdict.unit)}" if misses(verdict, y) else "")


def _slower_than(speed: float, curve: Curve) -> float | None:
    """Return when the train first ran slower than a speed (km/h); None where it never did."""
    below = np.flatnonzero(curve.y < speed)
    return float(curve.x[below[0]]) if len(below) else None
