"""The slip-brake test over friction and cleaning as maps, and two of its stops over the distance."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import NDArray

from studies.figures.style import INK, MUTED, ORANGE, WHEELSETS, WIDTH, from_zero
from uictest import Recording
from uictest.units import PERCENT

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_COLOURS = "Blues"
_DARK = 0.6
"""Share of the scale above which a number is written in white."""
_MAPS = {
    "sliding": "Time in which half of the wheelsets slide, % (framed: the slip-brake test counts)",
    "extension": "Extension over the dry stop, %",
}


class _Test(Protocol):
    @property
    def controller(self) -> str: ...
    @property
    def energy(self) -> str: ...
    @property
    def friction(self) -> float: ...
    @property
    def counts(self) -> bool: ...


def draw_maps(tests: Sequence[_Test], figure: Figure) -> None:
    """Draw a column of maps for each controller; a frame marks where the test counts."""
    figure.set_size_inches(WIDTH, 5.0)
    controllers = list(dict.fromkeys(test.controller for test in tests))
    rows: Any = figure.subfigures(len(_MAPS), 1)
    for row, (quantity, title) in zip(rows, _MAPS.items(), strict=True):
        panels = row.subplots(1, len(controllers), sharex=True, sharey=True)
        most = max(getattr(test, quantity) for test in tests)
        for axes, controller in zip(panels, controllers, strict=True):
            own = [test for test in tests if test.controller == controller]
            image = _draw_map(axes, own, quantity, most)
            axes.set_title(controller)
        panels[0].set_ylabel("energy that cleans")
        row.colorbar(image, ax=panels, pad=0.01)
        row.suptitle(title, x=0.0, ha="left", fontsize=8.5, fontweight="bold")
    for axes in panels:
        axes.set_xlabel("friction coefficient of the rail as found")


def _draw_map(axes: Axes, tests: Sequence[_Test], quantity: str, most: float) -> Any:
    frictions = list(dict.fromkeys(test.friction for test in tests))
    energies = list(dict.fromkeys(test.energy for test in tests))
    values: NDArray[np.float64] = np.full((len(energies), len(frictions)), np.nan)
    for test in tests:
        row, column = energies.index(test.energy), frictions.index(test.friction)
        value = values[row, column] = getattr(test, quantity)
        colour = "white" if value > _DARK * most else INK
        axes.text(column, row, f"{value:.0f}", ha="center", va="center", color=colour, fontsize=7.0)
        if test.counts:
            _frame(axes, column, row)
    axes.set_xticks(range(len(frictions)), [f"{friction:.2f}" for friction in frictions])
    axes.set_yticks(range(len(energies)), energies)
    axes.grid(visible=False)
    axes.spines[:].set_visible(False)
    axes.tick_params(length=0)
    return axes.imshow(values, cmap=_COLOURS, vmin=0.0, vmax=most, aspect="auto")


def _frame(axes: Axes, column: int, row: int) -> None:
    left, right, top, bottom = column - 0.42, column + 0.42, row - 0.4, row + 0.4
    x, y = [left, right, right, left, left], [top, top, bottom, bottom, top]
    axes.plot(x, y, color=ORANGE, linewidth=1.3, solid_joinstyle="miter")


def draw_stops(stops: Mapping[str, Recording], figure: Figure) -> None:
    """Draw cleaned share and friction under each wheelset over its distance, a column for each stop."""
    figure.set_size_inches(WIDTH, 3.6)
    panels = figure.subplots(2, len(stops), sharex=True, sharey="row", squeeze=False)
    for column, (name, stop) in enumerate(stops.items()):
        shares, frictions = panels[0][column], panels[1][column]
        for n, colour in WHEELSETS.items():
            share = stop[f"cleaned_share_{n}"] / PERCENT
            shares.plot(stop["distance"], share, color=colour, linewidth=0.7, label=f"wheelset {n}")
            frictions.plot(stop["distance"], stop[f"friction_{n}"], color=colour, linewidth=0.7)
        frictions.axhline(float(stop["friction_1"][0]), color=MUTED, linewidth=0.9, linestyle=(0, (4, 2)))
        frictions.set_xlabel("distance of the train, m")
        shares.set_title(name)
    for axes in panels.flat:
        from_zero(axes)
    handles, labels = panels[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(WHEELSETS))
    panels[0][0].set_ylabel("cleaned share, %")
    panels[1][0].set_ylabel("friction met")
