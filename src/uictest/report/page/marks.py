"""Criteria as they are drawn into the plots: limits, windows and bands, where the stop was judged by them."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from uictest.report.escaping import printable
from uictest.report.wording import number, quantity

if TYPE_CHECKING:
    from uictest.evaluation import CaseResult, Verdict
    from uictest.report.page.trace import Trace

Kind = Literal["limit", "found", "window", "band"]
_GRAVITY = 9.80665  # m/s2


@dataclass(frozen=True, slots=True)
class Mark:
    """Something drawn into a plot beside its lines, in the plot's units.

    limit, found: a level line at `y` from `x0` to `x1`. window, band: everything between `x0` and `x1`; None
    where it has no end.
    """

    plot: str
    kind: Kind
    label: str
    x0: float | None = None
    x1: float | None = None
    y: float | None = None


def marks_of(result: CaseResult, trace: Trace) -> list[Mark]:
    """Return the marks of every criterion that applied to a stop."""
    return [mark for verdict in result.criteria for mark in _marks(verdict, trace)]


def _marks(verdict: Verdict, trace: Trace) -> Iterator[Mark]:
    draw = _DRAWN.get(_measure(verdict))
    if draw is not None and verdict.verdict != "not_applicable":
        yield from draw(verdict, trace)


def _measure(verdict: Verdict) -> str:
    """Return the name of the measure of a verdict, which holds what the name means."""
    from uictest.scenario.parts.measure_catalogue import MEASURES

    meant = verdict.definition.get("measure")
    return next((name for name, measure in MEASURES.items() if measure.meaning == meant), "")


def _initial_adhesion(verdict: Verdict, trace: Trace) -> Iterator[Mark]:
    duration = _defined(verdict, "first_phase_duration", "s")
    if trace.sliding_time is None or duration is None:
        return
    start, end = trace.sliding_time, trace.sliding_time + duration
    yield Mark("speed", "window", f"first phase, {number(duration)} s", start, end)
    yield Mark("deceleration", "window", "", start, end)
    yield from _limits(verdict, "deceleration", x0=start, x1=end)
    if verdict.value is not None:
        yield Mark(
            "deceleration",
            "found",
            f"mean {verdict.value:.4g} {verdict.unit}",
            start,
            end,
            verdict.value,
        )


def _slide(verdict: Verdict, trace: Trace) -> Iterator[Mark]:
    cutoff = _defined(verdict, "low_speed_cutoff", "km/h")
    yield from _limits(verdict, "slide", x1=None if cutoff is None else _slower_than(cutoff, trace))


def _braking_distance(verdict: Verdict, trace: Trace) -> Iterator[Mark]:
    label = f"{printable(verdict.id)}: {number(verdict.lower)} .. {quantity(verdict.upper, verdict.unit)}"
    yield Mark("over-distance", "band", label, verdict.lower, verdict.upper)


def _level(plot: str, scale: float = 1.0) -> Callable[[Verdict, Trace], Iterator[Mark]]:
    return lambda verdict, trace: _limits(verdict, plot, scale=scale)


def _limits(
    verdict: Verdict, plot: str, *, x0: float | None = None, x1: float | None = None, scale: float = 1.0
) -> Iterator[Mark]:
    for bound in (verdict.lower, verdict.upper):
        if bound is not None and math.isfinite(bound):
            yield Mark(plot, "limit", f"limit {quantity(bound, verdict.unit)}", x0, x1, bound / scale)


_DRAWN: dict[str, Callable[[Verdict, Trace], Iterator[Mark]]] = {
    "initial_adhesion": _initial_adhesion,
    "maximum_slide_above_cutoff": _slide,
    "braking_distance": _braking_distance,
    "reservoir_minimum_pressure": _level("pressure"),
    "maximum_clamping_force": _level("force"),
    "minimum_deceleration": _level("deceleration", _GRAVITY),
    "maximum_deceleration": _level("deceleration", _GRAVITY),
}


def _defined(verdict: Verdict, name: str, unit: str) -> float | None:
    """Return the number at the beginning of a definition's text, None where it is in another unit."""
    found = re.match(rf"([\d.e+-]+) {re.escape(unit)}(?![\w/])", verdict.definition.get(name, ""))
    return float(found.group(1)) if found else None


def _slower_than(speed: float, trace: Trace) -> float | None:
    """Return when the train first ran slower than a speed (km/h); None where it never did."""
    if "speed" not in trace.series:
        return None
    below = np.flatnonzero(trace.series["speed"] < speed)
    return float(trace.time[below[0]]) if len(below) else None
