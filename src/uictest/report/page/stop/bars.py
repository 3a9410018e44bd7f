"""Bars in the rows of wheelsets: magnets of valves, and intervals that decided a criterion."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from uictest.report.page.axis import Axis
from uictest.report.page.stop.mark import Mark
from uictest.report.traces.quantities import VENT, WHEELSETS, Lane, Strip
from uictest.report.traces.trace import PlotTrace, States

Bar = tuple[float, float, float]
"""Beginning and end (s), and row: the number of the wheelset, or that of a lane beside it."""

_HALF_HEIGHTS = {"magnet": 0.17, "interval": 0.46}
"""Of a bar, where a row is 1 high: an interval that is marked shows above and below the magnets in it."""
_LEAST_WIDTH = 1.0
"""Pixels: a state that is drawn is never narrower."""


def magnet_bars(trace: PlotTrace, lanes: Sequence[Lane]) -> dict[str, list[Bar]]:
    """Return the bars of the magnets by kind; no kind has none."""
    bars = {
        f"magnet {lane.label} role-wheelset-{n}": _bars(states, lane.states, n + lane.offset, trace.end)
        for n in WHEELSETS
        if (states := trace.states.get(f"valve_command_{n}")) is not None
        for lane in lanes
    }
    return {kind: own for kind, own in bars.items() if own}


def vents(trace: PlotTrace, n: int) -> list[Bar]:
    """Return the vents of a wheelset; none where its valve was not recorded."""
    states = trace.states.get(f"valve_command_{n}")
    return [] if states is None else _bars(states, (VENT,), n, trace.end)


def mark_bars(marks: Iterable[Mark], strip: Strip) -> dict[str, list[Bar]]:
    """Return the intervals that are marked in a strip, by the kind of their bars; lanes lie above them."""
    kind = "interval behind" if strip.lanes else "interval"
    bars: dict[str, list[Bar]] = {}
    for mark in marks:
        if mark.plot == strip.key and mark.x0 is not None and mark.x1 is not None and mark.y is not None:
            bars.setdefault(f"{kind} mark-{mark.status}", []).append((mark.x0, mark.x1, mark.y))
    return bars


def bars_path(kind: str, bars: Iterable[Bar], x: Axis, y: Axis) -> str:
    """Return SVG path data of bars."""
    half = _HALF_HEIGHTS[kind.partition(" ")[0]]
    return "".join(
        _rectangle(x.at(first), x.at(last), y.at(row - half), y.at(row + half)) for first, last, row in bars
    )


def _bars(states: States, wanted: Sequence[int], row: float, end: float) -> list[Bar]:
    """Return the intervals in which a valve is in one of some states; those that follow at once are one."""
    times = np.append(states.time, end)
    ends = np.flatnonzero(np.diff(np.isin(states.state, wanted), prepend=False, append=False))
    return [(float(times[a]), float(times[b]), row) for a, b in ends.reshape(-1, 2).tolist()]


def _rectangle(first: float, last: float, upper: float, lower: float) -> str:
    width = f"{max(last - first, _LEAST_WIDTH):.4g}"
    return f"M{first:.1f} {upper:.1f}h{width}v{lower - upper:.1f}h-{width}z"
