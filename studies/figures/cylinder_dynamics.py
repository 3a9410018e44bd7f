"""Pressures under the same valve commands, and their differences from that of the cylinder."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from studies.figures.style import BAND, INK, SETTINGS, WIDTH, from_zero, title_and_legend
from studies.model_errors import PRESSURE_CHANNELS
from uictest import Recording
from uictest.units import BAR, PERCENT

if TYPE_CHECKING:
    from matplotlib.figure import Figure


_CURVES = {
    "none": ("tank 2", "-"),
    "full": ("behind the cylinder dynamics", "--"),
    "thermal": ("modelled air", "-"),
}
"""Label and dashes of the pressure under each setting."""


def draw(recording: Recording, top: float, limit: float, figure: Figure) -> None:
    """Draw tank 2, as it is and compensated in two ways, and cylinder 1.

    Differences are shown in % of `top`, Pa; `limit` is the bound on them, %.
    """
    figure.set_size_inches(WIDTH, 4.4)
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(1.3, 1.0))
    time, cylinder = recording["time"], recording["cylinder_pressure_1"]
    above.plot(time, cylinder / BAR, color=INK, linewidth=1.6, label="cylinder 1")
    below.axhspan(-limit, limit, color=BAND, zorder=0)
    for setting, (label, dashes) in _CURVES.items():
        pressure, colour = recording[PRESSURE_CHANNELS[setting]], SETTINGS[setting]
        difference = (pressure - cylinder) / top / PERCENT
        above.plot(time, pressure / BAR, dashes, color=colour, label=label)
        below.plot(time, difference, color=colour, label=f"{label}: at most {np.abs(difference).max():.1f} %")
    above.set(ylabel="pressure, bar")
    below.set(xlabel="time, s", ylabel="% of maximum pressure")
    title_and_legend(above, "Same valve commands on both modules", 4)
    title_and_legend(below, f"Difference from cylinder 1 (paper: below {limit:g} %)", 3)
    from_zero(above)
