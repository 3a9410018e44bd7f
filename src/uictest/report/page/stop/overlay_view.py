"""Two sides laid over each other, and data packed as text inside a page."""

from __future__ import annotations

import base64
import json
import zlib
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.report.escaping import printable
from uictest.report.page.stop.drawing import Drawing, panels_over_time
from uictest.report.page.stop.mark import Mark
from uictest.report.traces.quantities import Panel, PlotLine
from uictest.report.traces.trace import Curve, PlotTrace

STEPS = 32766
"""Into so many steps the range of a line is divided."""

_MISSING = 32767

Series = NDArray[np.float64]
Scale = tuple[float, float]
"""Offset and step: value = offset + step x number."""


def script_json(content: Any) -> str:
    """Return JSON that can stand inside a script element, whatever texts it holds."""
    text = json.dumps(content, separators=(",", ":"), ensure_ascii=True, allow_nan=False)
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


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
    numbers = {key: number for number, key in enumerate(grids)}
    across = {key: _scale_of_times(x, interval) for key, x in grids.items()}
    up = {name: _scale(curve.y, (steps or {}).get(name, 0.0)) for name, curve in curves.items()}
    parts = [
        *(_differences(_numbers(x, across[key])) for key, x in grids.items()),
        *(_differences(_numbers(curve.y, up[name])) for name, curve in curves.items()),
    ]
    data = np.concatenate(parts).astype("<i2") if parts else np.zeros(0, "<i2")
    deflated = zlib.compress(data.view(np.uint8).reshape(-1, 2).T.tobytes(), 6)
    return {
        "grids": [{"count": len(x), "scale": across[key]} for key, x in grids.items()],
        "lines": {name: {"grid": numbers[id(curve.x)], "scale": up[name]} for name, curve in curves.items()},
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


def _numbers(series: Series, scale: Scale) -> NDArray[np.int64]:
    offset, step = scale
    known = np.isfinite(series)
    numbers = np.rint((np.where(known, series, offset) - offset) / step)
    return np.where(known, numbers, _MISSING).astype(np.int64)


def _differences(numbers: NDArray[np.int64]) -> NDArray[np.int64]:
    return np.diff(numbers, prepend=np.int64(0))


class OverlayView(NamedTuple):
    """Panels as drawings, and the JSON that they are drawn from when they can be zoomed.

    There is a drawing for each group of panels: a page of paper holds some, not all.
    """

    drawings: list[Drawing]
    data: str


def overlay_view(
    title: str,
    sampling: str,
    trace: PlotTrace,
    groups: Sequence[Sequence[tuple[Panel, Sequence[PlotLine]]]],
    marks: Sequence[Mark],
    *,
    over_distance: Mapping[str, Curve],
    marks_over_distance: Sequence[Mark] = (),
) -> OverlayView:
    """Return the view of panels, one group below the other.

    Args:
        title: what was recorded.
        sampling: how the points of the lines were taken.
        trace: the lines over time.
        groups: panels that belong together.
        marks: in these panels, over time.
        over_distance: the lines over distance, under the names of those over time; empty without them.
        marks_over_distance: in the same panels.

    """
    data = {
        "id": printable(title),
        "sampling": sampling,
        "start": trace.start,
        "end": trace.end,
        "over_time": packed(trace.curves, trace.interval),
        "over_distance": packed(over_distance),
        "marks": [mark._asdict() for mark in marks],
        "marks_over_distance": [mark._asdict() for mark in marks_over_distance],
        "panels": [panel_form(panel, lines) for group in groups for panel, lines in group],
    }
    return OverlayView([panels_over_time(trace, group) for group in groups], script_json(data))


def panel_form(panel: Panel, lines: Sequence[PlotLine]) -> dict[str, object]:
    """Return a panel with its lines as the script takes it."""
    return panel._asdict() | {"lines": [line._asdict() for line in lines]}
