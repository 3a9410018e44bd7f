"""Force over pressure in a stop with sliding: samples by phase, and the lines identified from them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from studies.figures.style import MUTED, PHASES, WIDTH, from_zero
from studies.phases import TITLES, on_phases
from uictest import Recording
from uictest.rig import identification
from uictest.units import BAR, KILONEWTON

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_EVERY = 10
_HEADROOM = 1.15
"""Height of the axes over the largest force: room for the legend."""


def draw(recording: Recording, hysteresis: identification.HysteresisResult, figure: Figure) -> None:
    """Draw the BC phases on the left and the WSP phases on the right."""
    figure.set_size_inches(WIDTH, 3.5)
    left, right = figure.subplots(1, 2, sharex=True, sharey=True)
    _draw_pair(left, recording, hysteresis, "bc")
    _draw_pair(right, recording, hysteresis, "wsp")
    left.set(title="Ordinary braking (BC)", xlabel="cylinder pressure, bar", ylabel="clamping force, kN")
    right.set(title="While the WSP acts", xlabel="cylinder pressure, bar")
    from_zero(left)
    left.set_ylim(top=_HEADROOM * hysteresis.largest_force / KILONEWTON)


def _draw_pair(
    axes: Axes, recording: Recording, hysteresis: identification.HysteresisResult, pair: str
) -> None:
    pressure, force = recording["measured_pressure_1"] / BAR, recording["clamping_force_1"] / KILONEWTON
    axes.plot(pressure[::_EVERY], force[::_EVERY], color=MUTED, alpha=0.35, linewidth=0.7)
    for phase, mask in on_phases(recording).items():
        if phase.startswith(pair):
            points = np.flatnonzero(mask)[::_EVERY]
            axes.plot(pressure[points], force[points], ".", color=PHASES[phase], markersize=2.5)
    for phase, line in hysteresis.lines.items():
        if phase.startswith(pair):
            ends = np.array([line.pressure(1e-9), line.pressure(hysteresis.largest_force)])
            slope = line.slope * BAR / KILONEWTON
            intercept = line.intercept / KILONEWTON
            label = f"{TITLES[phase]}: {slope:.2f} kN/bar, {intercept:.2f} kN".replace("-", "\N{MINUS SIGN}")
            axes.plot(ends / BAR, line.force(ends) / KILONEWTON, color=PHASES[phase], label=label)
    if axes.get_legend_handles_labels()[0]:
        axes.legend(loc="upper left")
    else:
        axes.text(0.05, 0.95, "not in this stop", transform=axes.transAxes, va="top", color=MUTED)
