"""Series of two sides and their differences in panels of their own, as a page needs them."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from uictest.report.escaping import printable
from uictest.report.page.stop.mark import Mark
from uictest.report.page.stop.packing import packed, script_json
from uictest.report.page.stop.sketch import Sketch, panels_over_time
from uictest.report.traces.quantities import Panel, PlotLine
from uictest.report.traces.trace import Curve, PlotTrace

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
