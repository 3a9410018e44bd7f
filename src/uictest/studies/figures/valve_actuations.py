"""Pressure of a module over time with its vents, a panel for each origin of the clamping force."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from uictest.recording import Recording
from uictest.studies.figures.style import BLUE, INK, ORANGE, WIDTH, from_zero
from uictest.units import BAR

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_VENT = 2


@dataclass(frozen=True, slots=True)
class ActuationPanel:
    """One module of one stop."""

    title: str
    recording: Recording
    module: int


def draw(traces: Sequence[ActuationPanel], figure: Figure) -> None:
    """Draw the panels one below the other; a tick below the pressure marks each opening of the vent."""
    figure.set_size_inches(WIDTH, 1.55 * len(traces) + 0.3)
    panels = figure.subplots(len(traces), 1, sharex=True, sharey=True)
    for axes, trace, colour in zip(panels, traces, (INK, ORANGE, BLUE), strict=False):
        time = trace.recording["time"]
        axes.plot(time, trace.recording[f"tank_pressure_{trace.module}"] / BAR, color=colour)
        opened = openings(trace)
        axes.plot(
            time[opened], np.full(len(opened), 0.18), "|", color=colour, markersize=8, markeredgewidth=1.4
        )
        axes.set(title=f"{trace.title}: {len(opened)} actuations", ylabel="pressure, bar")
        from_zero(axes)
    panels[-1].set_xlabel("time, s")


def openings(trace: ActuationPanel) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
    """Return the samples at which the module is commanded to open its vent."""
    venting = trace.recording[f"valve_command_{trace.module}"] == _VENT
    return np.flatnonzero(venting[1:] & ~venting[:-1]) + 1
