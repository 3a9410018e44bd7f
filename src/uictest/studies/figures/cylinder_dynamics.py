"""Pressures under the same valve commands, and their differences from that of the cylinder."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from uictest.recording import Recording
from uictest.studies.figures.style import BAND, BLUE, INK, ORANGE, WIDTH, from_zero, title_and_legend
from uictest.units import BAR, PERCENT

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def draw(recording: Recording, top: float, limit: float, figure: Figure) -> None:
    """Draw tank 2, before and after the cylinder dynamics, and cylinder 1.

    Differences are shown in % of `top`, Pa; `limit` is the bound on them, %.
    """
    figure.set_size_inches(WIDTH, 4.4)
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(1.3, 1.0))
    time, cylinder = recording["time"], recording["tank_pressure_1"]
    tank, filtered = recording["tank_pressure_2"], recording["cylinder_pressure_2"]
    above.plot(time, cylinder / BAR, color=INK, linewidth=1.6, label="cylinder 1")
    above.plot(time, tank / BAR, color=ORANGE, label="tank 2")
    above.plot(time, filtered / BAR, "--", color=BLUE, label="tank 2 behind the cylinder dynamics")
    above.set(ylabel="pressure, bar")
    below.axhspan(-limit, limit, color=BAND, zorder=0)
    before, after = ((each - cylinder) / top / PERCENT for each in (tank, filtered))
    below.plot(time, before, color=ORANGE, label=f"before: at most {np.abs(before).max():.1f} %")
    below.plot(time, after, color=BLUE, label=f"after: at most {np.abs(after).max():.1f} %")
    below.set(xlabel="time, s", ylabel="% of maximum pressure")
    title_and_legend(above, "Same valve commands on both modules", 3)
    title_and_legend(below, f"Difference from cylinder 1 (paper: below {limit:g} %)", 2)
    from_zero(above)
