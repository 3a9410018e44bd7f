"""Computed and measured force, and their difference."""

from __future__ import annotations

from typing import TYPE_CHECKING

from uictest.recording import Recording
from uictest.studies.figures.style import BAND, BLUE, INK, ORANGE, WIDTH, from_zero, title_and_legend
from uictest.units import KILONEWTON, PERCENT

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def draw(recording: Recording, limit: float, figure: Figure) -> None:
    """Draw the force of the loadcells, and that computed from tank 2 with both models and with neither."""
    figure.set_size_inches(WIDTH, 4.4)
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(1.3, 1.0))
    time, measured = recording["time"], recording["clamping_force_1"]
    full, none = recording["computed_force_full_2"], recording["computed_force_none_2"]
    above.plot(time, measured / KILONEWTON, color=INK, linewidth=1.6, label="measured")
    above.plot(time, none / KILONEWTON, color=ORANGE, linewidth=0.9, label="straight line")
    above.plot(time, full / KILONEWTON, "--", color=BLUE, label="both models")
    above.set(ylabel="clamping force, kN")
    below.axhspan(-limit, limit, color=BAND, zorder=0)
    largest = measured.max()
    below.plot(time, (none - measured) / largest / PERCENT, color=ORANGE, linewidth=0.9)
    below.plot(time, (full - measured) / largest / PERCENT, color=BLUE)
    below.set(
        title=f"Computed less measured (paper: within \N{PLUS-MINUS SIGN}{limit:g} %)",
        xlabel="time, s",
        ylabel="% of largest force",
    )
    title_and_legend(above, "Clamping force under the same valve commands", 3)
    from_zero(above)
