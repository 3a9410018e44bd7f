"""Series of two sides in panels of their own, as a page needs them."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass

from uictest.report.page.stop.packing import packed, script_json
from uictest.report.page.stop.sketch import Sketch, panels_over_time
from uictest.report.traces.quantities import Panel, PlotLine
from uictest.report.traces.trace import PlotTrace


@dataclass(frozen=True, slots=True)
class OverlayView:
    """Panels drawn as a sketch, and the JSON that they are drawn from when they can be zoomed."""

    key: str
    title: str
    sketch: Sketch
    data: str


def overlay_view(
    key: str, title: str, trace: PlotTrace, panels: Sequence[tuple[Panel, Sequence[PlotLine]]]
) -> OverlayView:
    """Return the view of panels with the lines they show."""
    drawn = panels_over_time(trace, panels, [])
    data = {
        "start": trace.start,
        "end": trace.end,
        "over_time": packed(trace.curves, trace.interval),
        "loops": packed({}),
        "states": [],
        "marks": [],
        "panels": [panel_form(panel, lines) for panel, lines in panels],
    }
    return OverlayView(key, title, drawn, script_json(data))


def panel_form(panel: Panel, lines: Sequence[PlotLine]) -> dict[str, object]:
    """Return a panel with its lines as the script takes it."""
    return dataclasses.asdict(panel) | {"lines": [dataclasses.asdict(line) for line in lines]}
