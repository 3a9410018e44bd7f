"""Bars in the rows of wheelsets: valve states, and intervals that decided a criterion."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise

from uictest.report.page.axis import Axis
from uictest.report.page.stop.mark import Mark
from uictest.report.traces.quantities import WHEELSETS
from uictest.report.traces.trace import PlotTrace, States

Bar = tuple[float, float, float]
"""Beginning and end (s), and row: the number of the wheelset."""

FILL, HOLD, VENT = 0, 1, 2
_HALF_HEIGHT = 0.36
"""Of a bar, where a row is 1 high."""
_HALF_HEIGHT_MARKED = 0.46
"""Of an interval that is marked, so that it shows above and below the states in it."""
_LEAST_WIDTH = 1.0
"""Pixels: a state that is drawn is never narrower."""


def state_bars(trace: PlotTrace) -> dict[str, list[Bar]]:
    """Return the bars of the valve states by kind, what is painted first coming first.

    Fill, the state of every valve without WSP action, is only drawn after another state.
    """
    rows = [(n, trace.states[name]) for n in WHEELSETS if (name := f"valve_command_{n}") in trace.states]
    if not rows:
        return {}
    hold, fill, vent = (
        [bar for n, states in rows for bar in _bars(states, state, n, trace.end)]
        for state in (HOLD, FILL, VENT)
    )
    return {"hold": hold, "fill": [bar for bar in fill if bar[0] > trace.start], "vent": vent}


def vents(trace: PlotTrace, n: int) -> list[Bar]:
    """Return the vents of a wheelset; none where its valve was not recorded."""
    states = trace.states.get(f"valve_command_{n}")
    return [] if states is None else _bars(states, VENT, n, trace.end)


def mark_bars(marks: Iterable[Mark], strip: str) -> dict[str, list[Bar]]:
    """Return the intervals that are marked in a strip, by the kind of their bars."""
    bars: dict[str, list[Bar]] = {}
    for mark in marks:
        if mark.plot == strip and mark.x0 is not None and mark.x1 is not None and mark.y is not None:
            bars.setdefault(f"interval mark-{mark.status}", []).append((mark.x0, mark.x1, mark.y))
    return bars


def bars_path(kind: str, bars: Iterable[Bar], x: Axis, y: Axis) -> str:
    """Return SVG path data of bars."""
    half = _HALF_HEIGHT_MARKED if kind.startswith("interval") else _HALF_HEIGHT
    return "".join(
        _rectangle(x.at(first), x.at(last), y.at(row - half), y.at(row + half)) for first, last, row in bars
    )


def _bars(states: States, state: int, n: int, end: float) -> list[Bar]:
    times = [*states.time.tolist(), end]
    return [
        (first, last, n)
        for (first, last), each in zip(pairwise(times), states.state.tolist(), strict=True)
        if each == state
    ]


def _rectangle(first: float, last: float, upper: float, lower: float) -> str:
    width = f"{max(last - first, _LEAST_WIDTH):.4g}"
    return f"M{first:.1f} {upper:.1f}h{width}v{lower - upper:.1f}h-{width}z"
