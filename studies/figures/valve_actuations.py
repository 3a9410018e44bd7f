"""Pressure of a module over time with its vents, a panel for each origin of the clamping force."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from studies.figures.style import SETTINGS, WIDTH, from_zero
from studies.replay import VENT
from uictest import Recording
from uictest.units import BAR

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, slots=True)
class ActuationPanel:
    """One module of one stop, in the colour of a setting of the compensation."""

    title: str
    recording: Recording
    module: int
    setting: str


def draw(panels: Sequence[ActuationPanel], figure: Figure) -> None:
    """Draw the panels one below the other; a tick below the pressure marks each opening of the vent."""
    figure.set_size_inches(WIDTH, 1.55 * len(panels) + 0.3)
    all_axes = figure.subplots(len(panels), 1, sharex=True, sharey=True)
    for axes, panel in zip(all_axes, panels, strict=True):
        time, colour = panel.recording["time"], SETTINGS[panel.setting]
        axes.plot(time, panel.recording[f"tank_pressure_{panel.module}"] / BAR, color=colour)
        opened = openings(panel)
        axes.plot(
            time[opened], np.full(len(opened), 0.18), "|", color=colour, markersize=8, markeredgewidth=1.4
        )
        axes.set(title=f"{panel.title}: {len(opened)} actuations", ylabel="pressure, bar")
        from_zero(axes)
    all_axes[-1].set_xlabel("time, s")


def openings(panel: ActuationPanel) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
    """Return the samples at which the module is commanded to open its vent."""
    venting = panel.recording[f"valve_command_{panel.module}"] == VENT
    return np.flatnonzero(venting[1:] & ~venting[:-1]) + 1
