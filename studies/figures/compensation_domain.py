"""Worst error over friction and brake position, a map for each setting of the compensation."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from studies.figures.style import INK, WIDTH
from studies.model_errors import UNITS_OF_ERRORS, ReplayErrors
from studies.stop_runner import constant_friction

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_COLOURS = "Blues"
"""One hue from light to dark: read by lightness alone."""
_TITLES = {
    "pressure_error": "Pressure error, worst of wheelsets and seeds",
    "force_error": "Force error, worst of wheelsets and seeds",
}
_DARK = 0.6
"""Share of the scale above which a number is written in white."""


def draw(replays: Sequence[ReplayErrors], figure: Figure) -> None:
    """Draw a row of maps for each error; a cell holds the worst of its wheelsets and seeds."""
    figure.set_size_inches(WIDTH, 5.2)
    rows: Any = figure.subfigures(2, 1)
    for row, error in zip(rows, UNITS_OF_ERRORS, strict=True):
        _draw_error(row, replays, error)


def _draw_error(figure: Any, replays: Sequence[ReplayErrors], error: str) -> None:
    settings = list(replays[0].errors)
    maps = [worst_by_cell(replays, error, setting) for setting in settings]
    most = max(float(values.max()) for values in maps)
    panels = figure.subplots(1, len(maps), sharex=True, sharey=True)
    for axes, setting, values in zip(panels, settings, maps, strict=True):
        image = axes.imshow(values, cmap=_COLOURS, vmin=0.0, vmax=most, aspect="auto")
        axes.set_title(setting)
        _write_numbers(axes, values, _DARK * most)
        axes.tick_params(axis="x", rotation=90.0)
    frictions, positions = cells(replays)
    panels[0].set_xticks(range(len(positions)), positions)
    panels[0].set_yticks(range(len(frictions)), [f"{friction:.2f}" for friction in frictions])
    panels[0].set_ylabel("friction coefficient")
    figure.colorbar(image, ax=panels, pad=0.01, label=UNITS_OF_ERRORS[error])
    figure.suptitle(_TITLES[error], x=0.0, ha="left", fontsize=8.5, fontweight="bold")


def _write_numbers(axes: Axes, values: NDArray[np.float64], dark: float) -> None:
    for (row, column), value in np.ndenumerate(values):
        colour = "white" if value > dark else INK
        axes.text(column, row, f"{value:.1f}", ha="center", va="center", color=colour, fontsize=7.0)
    axes.grid(visible=False)
    axes.spines[:].set_visible(False)
    axes.tick_params(length=0)


def cells(replays: Sequence[ReplayErrors]) -> tuple[list[float], list[str]]:
    """Return the frictions and the brake positions of replays, each once, in their order."""
    places = [_place(each) for each in replays]
    return list(dict.fromkeys(mu for mu, _ in places)), list(dict.fromkeys(name for _, name in places))


def worst_by_cell(replays: Sequence[ReplayErrors], error: str, setting: str) -> NDArray[np.float64]:
    """Return the worst error of a setting, %, in a row for each friction and a column for each position."""
    frictions, positions = cells(replays)
    values = np.zeros((len(frictions), len(positions)))
    for replay in replays:
        friction, position = _place(replay)
        cell = frictions.index(friction), positions.index(position)
        values[cell] = max(values[cell], getattr(replay.errors[setting], error))
    return values


def _place(replay: ReplayErrors) -> tuple[float, str]:
    return constant_friction(replay.case), replay.case.scenario.brake.position
