"""Style of the figures: sizes for a printed page, one palette, one colour for each part in all figures."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import SubFigure
    from matplotlib.image import AxesImage

WIDTH = 6.9
"""Width of a figure, in: 175 mm, the type area of a page."""

INK = "#22303c"
MUTED = "#7b8894"
BAND = "#e4eef5"
BLUE, ORANGE, GREEN, PINK, SKY = "#0b6fb3", "#d4580a", "#0a8f6c", "#b8518f", "#6fb1dd"
"""After Okabe and Ito, darkened for print: distinguishable with colour vision deficiency."""

WHEELSET_COLOURS = {1: BLUE, 2: ORANGE, 3: GREEN, 4: PINK}
SETTING_COLOURS = {
    "none": ORANGE,
    "hysteresis": PINK,
    "cylinder": GREEN,
    "full": BLUE,
    "thermal": SKY,
    "four-caliper": INK,
}
"""Settings of the compensation, and the rig that needs none."""
PHASE_COLOURS = {
    "bc_squeezing": BLUE,
    "bc_releasing": SKY,
    "wsp_squeezing": ORANGE,
    "wsp_releasing": "#f0a463",
}

RC: Any = {
    "font.family": "DejaVu Sans",
    "font.size": 8.0,
    "axes.titlesize": 8.5,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.labelsize": 8.0,
    "axes.labelcolor": INK,
    "axes.edgecolor": MUTED,
    "axes.linewidth": 0.7,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#e3e7ea",
    "grid.linewidth": 0.6,
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "xtick.labelsize": 7.5,
    "ytick.labelsize": 7.5,
    "xtick.major.width": 0.7,
    "ytick.major.width": 0.7,
    "lines.linewidth": 1.1,
    "lines.solid_capstyle": "round",
    "legend.fontsize": 7.5,
    "legend.frameon": False,
    "legend.handlelength": 1.8,
    "figure.facecolor": "white",
    "savefig.dpi": 200,
    # An SVG is the same to the byte whenever and wherever it is drawn.
    "svg.hashsalt": "uictest",
}
"""Settings of matplotlib."""


_DARK = 0.6
"""Share of the scale above which a number is written in white."""


def heat_map(axes: Axes, values: NDArray[np.float64], digits: int, most: float) -> AxesImage:
    """Draw values from zero to `most` as a map with the numbers in it: one hue, read by lightness alone."""
    for (row, column), value in np.ndenumerate(values):
        colour = "white" if value > _DARK * most else INK
        number = f"{value:.{digits}f}"
        axes.text(column, row, number, ha="center", va="center", color=colour, fontsize=7.0)
    axes.grid(visible=False)
    axes.spines[:].set_visible(False)
    axes.tick_params(length=0)
    return axes.imshow(values, cmap="Blues", vmin=0.0, vmax=most, aspect="auto")


def heading(figure: SubFigure, text: str) -> None:
    """Put a title above a part of a figure, as above axes."""
    figure.suptitle(text, x=0.0, ha="left", fontsize=8.5, fontweight="bold")


def from_zero(axes: Axes, *, across: bool = True, up: bool = True) -> None:
    """Start the axes at zero."""
    if across:
        axes.set_xlim(left=0.0)
    if up:
        axes.set_ylim(bottom=0.0)


def title_and_legend(axes: Axes, title: str, columns: int) -> None:
    """Put the title above the axes, and the legend in one row between title and axes."""
    axes.set_title(title, pad=17.0)
    axes.legend(
        loc="lower left",
        bbox_to_anchor=(0.0, 1.0),
        ncols=columns,
        borderaxespad=0.1,
        borderpad=0.2,
        columnspacing=1.6,
    )
