"""Panels over time as SVG paths: what paper shows, and a browser that does not draw them itself."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from uictest.report.page.axis import Axis, Tick, span
from uictest.report.traces.quantities import (
    PANELS,
    WHEELSETS,
    Panel,
    PlotLine,
    Strip,
    in_order,
    panel_lines,
)
from uictest.report.traces.trace import PlotTrace, Samples, extremes

ON_PAPER = ("speed", "pressure")
"""Keys of the panels of a stop that are drawn; the valves stand between them."""
LEFT, RIGHT = 52, 948
_HEIGHT, _TITLE, _GAP = 96, 22, 6  # of a panel of height 1, of its title, below it
_BELOW = 32  # the panels: tick labels and what they count
_LANE = 12  # of a lane of a strip
_COLUMN = 4.0
"""Pixels: of every column of a line only the extremes are kept, so that no peak is lost."""
_BAR, _LEAST_WIDTH = 0.34, 1.0
"""Height of a bar in its lane, and pixels that it is wide at least."""


class DrawnPanel(NamedTuple):
    """One panel, in pixels. `paths` holds the class and the data of each path."""

    key: str
    title: str
    top: float
    bottom: float
    x_ticks: Sequence[Tick]
    y_ticks: Sequence[Tick]
    paths: Sequence[tuple[str, str]]


class Drawing(NamedTuple):
    """Panels above each other over one time axis."""

    height: float
    panels: list[DrawnPanel]


def drawing_of(trace: PlotTrace) -> Drawing:
    """Return the drawing of a stop; quantities that it has no series of are left out."""
    return panels_over_time(trace, [(each, panel_lines(each)) for each in PANELS if each.key in ON_PAPER])


def panels_over_time(trace: PlotTrace, panels: Sequence[tuple[Panel, Sequence[PlotLine]]]) -> Drawing:
    """Return panels, and the valves where they belong; those without content are left out."""
    time = Axis(trace.start, trace.end if trace.end > trace.start else trace.start + 1.0, LEFT, RIGHT)
    lines = {panel.key: own for panel, own in panels}
    drawn: list[DrawnPanel] = []
    for each in in_order([panel for panel, _ in panels]):
        top = _TITLE + (drawn[-1].bottom + _GAP if drawn else 0.0)
        if isinstance(each, Strip):
            drawn += _strip(each, trace, time, top)
        else:
            drawn += _panel(each, lines[each.key], trace, time, top)
    return Drawing((drawn[-1].bottom + _GAP if drawn else 0.0) + _BELOW, drawn)


def _panel(
    panel: Panel, lines: Sequence[PlotLine], trace: PlotTrace, time: Axis, top: float
) -> Iterator[DrawnPanel]:
    curves = [(line, trace.curves[line.series]) for line in lines if line.series in trace.curves]
    if curves:
        bottom = top + panel.height * _HEIGHT
        bands = [(line, *trace.band[line.series]) for line, _ in curves if line.series in trace.band]
        drawn = [curve for _, curve in curves] + [edge for _, *edges in bands for edge in edges]
        y = Axis(*span((curve.y for curve in drawn), panel.include), bottom, top)
        paths = [
            (
                f"band role-{line.role} role-band",
                area_over_time(time.pixels(low.x), y.pixels(low.y), y.pixels(high.y)),
            )
            for line, low, high in bands
        ]
        paths += [
            (
                f"line role-{line.role}{' dotted' if line.dotted else ''}",
                path_over_time(time.pixels(curve.x), y.pixels(curve.y)),
            )
            for line, curve in curves
        ]
        title = f"{panel.title}, {panel.unit}"
        yield DrawnPanel(panel.key, title, top, bottom, time.tick_marks(10), y.tick_marks(4), paths)


def _strip(strip: Strip, trace: PlotTrace, time: Axis, top: float) -> Iterator[DrawnPanel]:
    bottom = top + len(WHEELSETS) * _LANE * len(strip.lanes)
    row = Axis(0.5, len(WHEELSETS) + 0.5, top, bottom)
    paths = []
    for lane in strip.lanes:
        for n in WHEELSETS:
            upper, lower = (row.at(n + lane.offset + side * _BAR / 2) for side in (-1, 1))
            bars = [
                f"M{first:.1f} {upper:.1f}h{max(last - first, _LEAST_WIDTH):.4g}V{lower:.1f}H{first:.1f}z"
                for times in trace.valve_spans(n, lane.states)
                for first, last in [map(time.at, times)]
            ]
            if bars:
                paths.append((f"magnet {lane.label} role-wheelset-{n}", "".join(bars)))
    if paths:
        ticks = [(row.at(place), label) for place, label in strip.rows]
        yield DrawnPanel(strip.key, strip.heading, top, bottom, time.tick_marks(10), ticks, paths)


def area_over_time(x: Samples, low: Samples, high: Samples) -> str:
    """Return the SVG path of what lies between two edges, all in pixels, where both are known."""
    known = np.isfinite(low) & np.isfinite(high)
    if not known.any():
        return ""
    x, low, high = x[known], low[known], high[known]
    columns = np.flatnonzero(np.diff(np.floor(x / _COLUMN), prepend=-1.0))
    upper = np.fmin.reduceat(high, columns)  # the larger value has the smaller pixel
    lower = np.fmax.reduceat(low, columns)
    outline = np.column_stack([[*x[columns], *x[columns][::-1]], [*upper, *lower[::-1]]])
    return f"{_stroke(np.rint(outline).astype(np.int64))}z"


def path_over_time(x: Samples, y: Samples) -> str:
    """Return the SVG path of a series over time, both in pixels; where y is missing the line has a gap."""
    kept = extremes(np.floor(x / _COLUMN), y)
    known = np.isfinite(x[kept]) & np.isfinite(y[kept])
    points = np.rint(np.column_stack([x[kept], np.where(known, y[kept], 0.0)])).astype(np.int64)
    ends = np.flatnonzero(np.diff(known, prepend=False, append=False))
    return "".join(_stroke(points[start:end]) for start, end in ends.reshape(-1, 2).tolist())


def _stroke(points: np.ndarray[tuple[int, int], np.dtype[np.int64]]) -> str:
    steps = np.diff(points, axis=0)
    moves = [f"l{across} {up}" for across, up in steps[steps.any(axis=1)].tolist()]
    return f"M{points[0, 0]} {points[0, 1]}" + "".join(moves)
