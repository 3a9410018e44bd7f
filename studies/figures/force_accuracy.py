"""Computed and measured force, and their difference."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studies.figures.style import BAND, INK, SETTINGS, WIDTH, from_zero, title_and_legend
from studies.model_errors import force_channel
from uictest import Recording
from uictest.units import KILONEWTON, PERCENT

if TYPE_CHECKING:
    from matplotlib.figure import Figure


_CURVES = {"none": ("straight line", "-"), "full": ("both models", "--"), "thermal": ("modelled air", "-")}
"""Label and dashes of the force under each setting."""


def draw(recording: Recording, limit: float, figure: Figure) -> None:
    """Draw the force of the loadcells, and those computed from tank 2; `limit` is in % of the largest."""
    figure.set_size_inches(WIDTH, 4.4)
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(1.3, 1.0))
    time, measured = recording["time"], recording["clamping_force_1"]
    above.plot(time, measured / KILONEWTON, color=INK, linewidth=1.6, label="measured")
    below.axhspan(-limit, limit, color=BAND, zorder=0)
    for setting, (label, dashes) in _CURVES.items():
        force, colour = recording[force_channel(setting)], SETTINGS[setting]
        above.plot(time, force / KILONEWTON, dashes, color=colour, linewidth=0.9, label=label)
        below.plot(time, (force - measured) / measured.max() / PERCENT, color=colour, linewidth=0.9)
    above.set(ylabel="clamping force, kN")
    below.set(
        title=f"Computed less measured (paper: within \N{PLUS-MINUS SIGN}{limit:g} %)",
        xlabel="time, s",
        ylabel="% of largest force",
    )
    title_and_legend(above, "Clamping force under the same valve commands", 4)
    from_zero(above)
