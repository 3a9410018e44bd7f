"""Force over pressure, a panel for each level of what was varied, with the lines of the four phases."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from studies.figures.style import MUTED, PHASES, WIDTH, from_zero
from studies.phases import TITLES, Loop
from uictest.units import BAR, KILONEWTON

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_EVERY = 10
_WIDTHS = {"bc": 2.6, "ws": 1.0}
"""Line widths: the lines of the WSP are drawn over the wider ones of the BC."""


def draw(stop_loops: Sequence[Loop], title: str, figure: Figure) -> None:
    """Draw one panel per stop; the level replaces the braces in `title`."""
    figure.set_size_inches(WIDTH, 3.1)
    panels = figure.subplots(1, len(stop_loops), sharex=True, sharey=True)
    for axes, loop in zip(panels, stop_loops, strict=True):
        pressure = loop.recording["measured_pressure_1"][::_EVERY] / BAR
        force = loop.recording["clamping_force_1"][::_EVERY] / KILONEWTON
        axes.plot(pressure, force, color=MUTED, alpha=0.5, linewidth=0.7)
        for phase, line in loop.lines.lines.items():
            ends = np.array([line.pressure(1e-9), line.pressure(loop.lines.largest_force)])
            axes.plot(
                ends / BAR,
                line.force(ends) / KILONEWTON,
                color=PHASES[phase],
                linewidth=_WIDTHS[phase[:2]],
                label=TITLES[phase],
                zorder=3,
            )
        axes.set(title=title.format(loop.level), xlabel="pressure, bar")
    from_zero(panels[0])
    panels[0].set_ylabel("clamping force, kN")
    handles = {
        label: line for axes in panels for line, label in zip(*axes.get_legend_handles_labels(), strict=True)
    }
    figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=4)
