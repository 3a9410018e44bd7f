"""The plots of a stop: as SVG for paper and for browsers without scripts, and as data for the script."""

from __future__ import annotations

import base64
import json
import zlib
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.report.page.marks import Mark
from uictest.report.page.plot import Axis, Tick, span
from uictest.report.traces.quantities import (
    LOOPS,
    ORDINARY_CREEP,
    PANELS,
    PLOT_QUANTITIES,
    STRIPS,
    WHEELSETS,
    Panel,
    PlotLine,
    Strip,
    in_order,
    key_of,
    loop_lines,
    panel_lines,
)
from uictest.report.traces.trace import BINS, MOST_SAMPLES, Curve, PlotTrace, Series, extremes
from uictest.report.words import printable

LEFT, RIGHT = 52, 948
"""Ends of the time axis, pixels."""
_ON_PAPER: Final = ("speed", "pressure")
"""Keys of the panels of a stop that are drawn; the valves stand between them."""
_HEIGHT, _TITLE, _GAP = 96, 22, 6  # of a panel of height 1, of its title, below it
_BELOW: Final = 32  # the panels: tick labels and what they count
_LANE: Final = 12  # of a lane of a strip; `.magnet` in the style sheet has the width of its bars
_COLUMN: Final = 5.0
"""Pixels: of every column of a line only the extremes are kept, so that no peak is lost."""
_LEAST_BAR_WIDTH: Final = 1.0
"""Pixels: a vent however short is seen."""


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
    # On paper cylinder pressures would hide those of the tanks, which they follow.
    hidden = "cylinder_pressure" if "tank_pressure_1" in trace.curves else ""
    panels = [panel for panel in PANELS if panel.key in _ON_PAPER]
    if hidden:
        panels = [panel._replace(title=panel.title.partition(" (cylinder")[0]) for panel in panels]
    return panels_over_time(
        trace,
        [(panel, [line for line in panel_lines(panel) if key_of(line.series) != hidden]) for panel in panels],
    )


def panels_over_time(trace: PlotTrace, panels: Sequence[tuple[Panel, Sequence[PlotLine]]]) -> Drawing:
    """Return panels, and the valves where they belong; those without content are left out."""
    time = Axis(trace.start, trace.end if trace.end > trace.start else trace.start + 1.0, LEFT, RIGHT)
    lines = {panel.key: lines_of_panel for panel, lines_of_panel in panels}
    drawn: list[DrawnPanel] = []
    for panel in in_order([panel for panel, _ in panels]):
        top = _TITLE + (drawn[-1].bottom + _GAP if drawn else 0.0)
        if isinstance(panel, Strip):
            drawn += _strip_panels(panel, trace, time, top)
        else:
            drawn += _panel(panel, lines[panel.key], trace, time, top)
    return Drawing((drawn[-1].bottom + _GAP if drawn else 0.0) + _BELOW, drawn)


def _panel(
    panel: Panel, lines: Sequence[PlotLine], trace: PlotTrace, time: Axis, top: float
) -> Iterator[DrawnPanel]:
    curves = [(line, trace.curves[line.series]) for line in lines if line.series in trace.curves]
    if not curves:
        return
    bottom = top + panel.height * _HEIGHT
    bands = [(line, *trace.band[line.series]) for line, _ in curves if line.series in trace.band]
    heights = [curve.y for _, curve in curves] + [edge.y for _, *edges in bands for edge in edges]
    y = Axis(*span(heights, panel.include), bottom, top)
    paths = []
    for line, low, high in bands:
        area = area_over_time(time.pixels(low.x), y.pixels(low.y), y.pixels(high.y))
        paths.append((f"band role-{line.role} role-band", area))
    for line, curve in curves:
        kind = f"line role-{line.role}{' dotted' if line.dotted else ''}"
        paths.append((kind, path_over_time(time.pixels(curve.x), y.pixels(curve.y))))
    title = f"{panel.title}, {panel.unit}"
    yield DrawnPanel(panel.key, title, top, bottom, time.tick_marks(10), y.tick_marks(4), paths)


def _strip_panels(strip: Strip, trace: PlotTrace, time: Axis, top: float) -> Iterator[DrawnPanel]:
    bottom = top + len(WHEELSETS) * _LANE * len(strip.lanes)
    row = Axis(0.5, len(WHEELSETS) + 0.5, top, bottom)
    paths = []
    for lane in strip.lanes:
        for n in WHEELSETS:
            bars, at = "", 0.0
            for start, end in trace.valve_spans(n, lane.states):
                left = round(time.at(start), 1)
                width = round(max(time.at(end) - left, _LEAST_BAR_WIDTH), 1)
                bars += f"m{left - at:.4g} 0h{width:g}"
                at = left + width
            if bars:
                paths.append(
                    (f"magnet {lane.label} role-wheelset-{n}", f"M0 {row.at(n + lane.offset):.1f}{bars}")
                )
    if paths or (strip.lanes and trace.states):
        ticks = [(row.at(height), label) for height, label in strip.rows]
        heading = strip.heading if paths else f"{strip.title}: no command in this stop"
        yield DrawnPanel(strip.key, heading, top, bottom, time.tick_marks(10), ticks, paths)


def area_over_time(x: Series, low: Series, high: Series) -> str:
    """Return the SVG path of what lies between two edges, all in pixels, where both are known."""
    known = np.isfinite(low) & np.isfinite(high)
    if not known.any():
        return ""
    x, low, high = x[known], low[known], high[known]
    columns = np.flatnonzero(np.diff(np.floor(x / _COLUMN), prepend=-1.0))
    upper = np.fmin.reduceat(high, columns)  # the larger value has the smaller pixel
    lower = np.fmax.reduceat(low, columns)
    outline = np.column_stack([[*x[columns], *x[columns][::-1]], [*upper, *lower[::-1]]])
    return f"{_stroke_path(np.rint(outline).astype(np.int64))}z"


def path_over_time(x: Series, y: Series) -> str:
    """Return the SVG path of a series over time, both in pixels; where y is missing the line has a gap."""
    rows = extremes(np.floor(x / _COLUMN), y)
    known = np.isfinite(x[rows]) & np.isfinite(y[rows])
    points = np.rint(np.column_stack([x[rows], np.where(known, y[rows], 0.0)])).astype(np.int64)
    ends = np.flatnonzero(np.diff(known, prepend=False, append=False))
    return "".join(_stroke_path(points[start:end]) for start, end in ends.reshape(-1, 2).tolist())


def _stroke_path(points: NDArray[np.int64]) -> str:
    steps = np.diff(points, axis=0)
    moves = " ".join(f"{across} {up}" for across, up in steps[steps.any(axis=1)].tolist())
    return f"M{points[0, 0]} {points[0, 1]}" + (f"l{moves.replace(' -', '-')}" if moves else "")


_COMPARED: Final = (
    Panel("speed", "Speed of train (bold) and wheelset", "km/h", ("wheel_speed", "speed"), 1.5),
    Panel("slide", "Slide", "%", ("slide",), include=(0.0, ORDINARY_CREEP)),
    Panel("pressure", "Tank pressure", "bar", ("tank_pressure",)),
    Panel("force", "Clamping force of one caliper", "kN", ("clamping_force",)),
    Panel("deceleration", "Deceleration", "g", ("deceleration",)),
    Panel("adhesion", "Adhesion", "dimensionless", ("adhesion",)),
)
"""Panels of two stops laid over each other, from top to bottom; the valves stand below the first."""


def script_json(content: Any) -> str:
    """Return JSON that can stand inside a script element, whatever texts it holds."""
    text = json.dumps(content, separators=(",", ":"), ensure_ascii=True, allow_nan=False)
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def plots_json() -> str:
    """Return the data that all cases share: panels, loops and their lines."""
    loops = [
        loop._asdict() | {"lines": [line._asdict() | {"over": across} for across, line in loop_lines(loop)]}
        for loop in LOOPS
    ]
    strips = [
        strip._asdict()
        | {"lanes": [lane._asdict() for lane in strip.lanes], "heading": strip.heading, "rows": strip.rows}
        for strip in STRIPS
    ]
    return script_json(
        {
            "panels": [panel_form(panel, panel_lines(panel)) for panel in PANELS],
            "loops": loops,
            "quantities": {key: quantity._asdict() for key, quantity in PLOT_QUANTITIES.items()},
            "strips": strips,
            "compared": [panel_form(panel, panel_lines(panel)) for panel in _COMPARED],
        }
    )


def panel_form(panel: Panel, lines: Sequence[PlotLine]) -> dict[str, object]:
    """Return a panel with its lines as the script takes it."""
    return panel._asdict() | {"lines": [line._asdict() for line in lines]}


def plot_data(
    title: str, trace: PlotTrace, marks: Sequence[Mark] = (), *, recorded: bool = False
) -> dict[str, Any]:
    """Return the data from which the script draws a stop; `recorded` where the stop was not simulated."""
    steps = {name: PLOT_QUANTITIES[key_of(name)].step for name in trace.curves}
    states = {name: Curve(time, state.astype(np.float64)) for name, (time, state) in trace.states.items()}
    data: dict[str, Any] = {}
    if trace.band:
        edges, steps_of_edges = {}, {}
        for name, band in trace.band.items():
            for end, edge in zip(("lowest", "highest"), band, strict=True):
                edges[f"{end} {name}"], steps_of_edges[f"{end} {name}"] = edge, steps[name]
        data["band"] = packed(edges, 0.0, steps_of_edges)
    return data | {
        "id": printable(title),
        "recorded": recorded,
        "sampling": sampling_text(trace),
        "start": trace.start,
        "end": trace.end,
        "over_time": packed({**trace.curves, **states}, trace.interval, steps),
        "marks": [_mark_form(mark) for mark in marks],
    }


def _mark_form(mark: Mark) -> dict[str, Any]:
    """Return the fields of a mark that are not as they usually are; the script knows the others."""
    fields = {
        name: value for name, value in mark._asdict().items() if value != Mark._field_defaults.get(name)
    }
    return {name: round(value, 6) if isinstance(value, float) else value for name, value in fields.items()}


def sampling_text(trace: PlotTrace) -> str:
    """Return the sentence on how the points of a line were taken from the stop."""
    is_long = trace.interval * MOST_SAMPLES < trace.end - trace.start
    part = milliseconds((trace.end - trace.start) / BINS)
    drawn = f", drawn through the smallest and the largest of every {part}" if is_long else ""
    return f"Sampled every {milliseconds(trace.interval)}{drawn}. Criteria use every step."


def milliseconds(seconds: float) -> str:
    """Return a time in ms with its unit."""
    return f"{1e3 * seconds:.3g} ms"


STEPS: Final = 32766
"""Into so many steps the range of a line is divided."""
_MISSING: Final = 32767
Scale = tuple[float, float]
"""Offset and step: value = offset + step x number."""


def packed(
    curves: Mapping[str, Curve], interval: float = 0.0, steps: Mapping[str, float] | None = None
) -> dict[str, Any]:
    """Return lines as `{"grids": [{"count", "scale"}], "lines": {name: {"grid", "scale"}}, "data"}`.

    Lines that share their array of x share a grid, the number of which they name. A value is `scale[0]` +
    `scale[1]` x number, 32767 in y for missing. `data` holds the numbers of every grid, then of every line,
    each as the difference from the number before it: signed, two bytes, all low bytes before all high ones,
    deflated, base64.

    Args:
        curves: lines by their names.
        interval: x is a multiple of this, and kept exactly; 0 where it is not.
        steps: name -> the step of its values; without one, or where the range has more than 32766, that is a
            32766th of the range.

    """
    grids = {id(curve.x): curve.x for curve in curves.values()}
    grid_numbers = {key: number for number, key in enumerate(grids)}
    x_scales = {key: _scale_of_times(x, interval) for key, x in grids.items()}
    y_scales = {name: _scale(curve.y, (steps or {}).get(name, 0.0)) for name, curve in curves.items()}
    parts = [
        *(_scaled_differences(x, x_scales[key]) for key, x in grids.items()),
        *(_scaled_differences(curve.y, y_scales[name]) for name, curve in curves.items()),
    ]
    data = np.concatenate(parts).astype("<i2") if parts else np.zeros(0, "<i2")
    deflated = zlib.compress(data.view(np.uint8).reshape(-1, 2).T.tobytes(), 9)
    return {
        "grids": [{"count": len(x), "scale": x_scales[key]} for key, x in grids.items()],
        "lines": {
            name: {"grid": grid_numbers[id(curve.x)], "scale": y_scales[name]}
            for name, curve in curves.items()
        },
        "data": base64.b64encode(deflated).decode("ascii"),
    }


def _scale(series: Series, step: float = 0.0) -> Scale:
    finite = series[np.isfinite(series)]
    low, high = (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 0.0)
    if step > 0.0 and high - low < (STEPS - 1) * step:
        return float(np.floor(low / step)) * step, step
    return low, (high - low) / STEPS or 1.0


def _scale_of_times(times: Series, interval: float) -> Scale:
    """Return the interval of the record as the step of its times, where two bytes hold the differences."""
    if interval > 0.0 and np.diff(times, prepend=times[:1]).max(initial=0.0) < STEPS * interval:
        return float(times[0]), interval
    return _scale(times)


def _scaled_differences(series: Series, scale: Scale) -> NDArray[np.int64]:
    """Return each number of a series less the one before it."""
    offset, step = scale
    known = np.isfinite(series)
    rounded = np.rint((np.where(known, series, offset) - offset) / step)
    numbers: NDArray[np.int64] = np.where(known, rounded, _MISSING).astype(np.int64)
    return np.diff(numbers, prepend=np.int64(0))
