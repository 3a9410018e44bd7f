"""Two sides laid over each other, and data packed as text inside a page."""

from __future__ import annotations

import base64
import dataclasses
import json
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uictest.report.escaping import printable
from uictest.report.page.stop.mark import Mark
from uictest.report.page.stop.sketch import Sketch, panels_over_time
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


def packed(curves: Mapping[str, Curve], interval: float = 0.0) -> dict[str, Any]:
    """Return lines as `{"lines": {name: {"count", "x", "y"}}, "data"}`; `x` and `y` are `[offset, step]`.

    A value is offset + step x number, 32767 in y for missing. `data` holds the numbers of every line, x
    before y, each as the difference from the number before it: signed, two bytes, all low bytes before all
    high ones, deflated, base64. What is lost of a value is at most half a step, a sixty-thousandth of the
    range; of an x that is a multiple of `interval`, nothing.
    """
    lines, parts = {}, []
    for name, curve in curves.items():
        across, up = _scale_of_times(curve.x, interval), _scale(curve.y)
        lines[name] = {"count": len(curve.x), "x": across, "y": up}
        parts += [_differences(_numbers(curve.x, across)), _differences(_numbers(curve.y, up))]
    numbers = np.concatenate(parts).astype("<i2") if parts else np.zeros(0, "<i2")
    data = zlib.compress(numbers.view(np.uint8).reshape(-1, 2).T.tobytes(), 6)
    return {"lines": lines, "data": base64.b64encode(data).decode("ascii")}


def _scale(series: Series) -> Scale:
    finite = series[np.isfinite(series)]
    low, high = (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 0.0)
    return low, (high - low) / STEPS or 1.0


def _scale_of_times(times: Series, interval: float) -> Scale:
    """Return the interval of the record as the step of its times, where two bytes hold the differences."""
    if interval > 0.0 and np.diff(times, prepend=times[:1]).max(initial=0.0) < STEPS * interval:
        return float(times[0]), interval
    return _scale(times)


def _numbers(series: Series, scale: Scale) -> NDArray[np.int64]:
    offset, step = scale
    known = np.isfinite(series)
    return np.where(known, np.rint((np.where(known, series, offset) - offset) / step), _MISSING).astype(
        np.int64
    )


def _differences(numbers: NDArray[np.int64]) -> NDArray[np.int64]:
    return np.diff(numbers, prepend=np.int64(0))


DrawnPanel = tuple[Panel, Sequence[PlotLine]]
"""A panel with the lines it shows."""


@dataclass(frozen=True, slots=True)
class OverlayView:
    """Panels drawn as sketches, and the JSON that they are drawn from when they can be zoomed.

    There is a sketch for each group of panels: a page of paper holds some, not all.
    """

    sketches: list[Sketch]
    data: str


def overlay_view(
    title: str,
    sampling: str,
    trace: PlotTrace,
    groups: Sequence[Sequence[DrawnPanel]],
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
        "loops": packed({}),
        "states": [],
        "marks": [dataclasses.asdict(mark) for mark in marks],
        "marks_over_distance": [dataclasses.asdict(mark) for mark in marks_over_distance],
        "panels": [panel_form(panel, lines) for group in groups for panel, lines in group],
    }
    return OverlayView([panels_over_time(trace, group, marks) for group in groups], script_json(data))


def panel_form(panel: Panel, lines: Sequence[PlotLine]) -> dict[str, object]:
    """Return a panel with its lines as the script takes it."""
    return dataclasses.asdict(panel) | {"lines": [dataclasses.asdict(line) for line in lines]}
