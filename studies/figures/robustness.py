"""Actuations at every point of the neighbourhood, and over friction with the counts of the paper."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from statistics import median
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from studies.figures.style import BAND, INK, MUTED, SETTINGS, WIDTH, from_zero, title_and_legend
from studies.neighbourhood import BANDS, PAPER, Counts

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_TITLES = {"four-caliper": "caliper in every module", "full": "full compensation", "none": "no compensation"}
_APART = 0.24


_SWEPT = {
    "caliper": ("module 1, caliper", INK, "o"),
    "none": ("module 2, no model", SETTINGS["none"], "s"),
    "full": ("module 2, both models", SETTINGS["full"], "^"),
}
"""Label, colour and mark of the counts that the paper gives."""
_ABREAST = 0.2
"""Distance between the marks of one friction, in steps of friction."""


class _Swept(Protocol):
    @property
    def friction(self) -> str: ...
    @property
    def counts(self) -> Mapping[str, Counts]: ...
    @property
    def in_bands(self) -> NDArray[np.bool_]: ...


def draw_points(counts: Mapping[str, Mapping[str, Sequence[float]]], figure: Figure) -> None:
    """Draw three columns of dots for each point, a stop a dot, the median a bar; counts by point and rig."""
    figure.set_size_inches(WIDTH, 3.3)
    axes = figure.subplots()
    for place, of in enumerate(counts.values()):
        for k, (name, values) in enumerate(of.items()):
            across, colour = place + (k - 1) * _APART, SETTINGS[name]
            axes.plot([across] * len(values), values, "o", color=colour, alpha=0.3, markersize=3.5, mew=0.0)
            label = _TITLES[name] if place == 0 else None
            axes.plot(
                [across - 0.09, across + 0.09], [median(values)] * 2, color=colour, linewidth=2.4, label=label
            )
    axes.set_xticks(range(len(counts)), [title.replace(", ", "\n") for title in counts])
    axes.grid(visible=False, axis="x")
    axes.set(
        xlabel="friction coefficient and command",
        ylabel="actuations, mean of modules 2-4",
    )
    title_and_legend(axes, "Valve actuations per wheelset", 3)
    from_zero(axes, across=False)


def draw_sweep(sweep: Sequence[_Swept], figure: Figure) -> None:
    """Draw the median and the range of the paper's three counts over friction, and the paper's counts."""
    figure.set_size_inches(WIDTH, 3.3)
    axes = figure.subplots()
    for low, high in set(BANDS.values()):
        axes.axhspan(low, high, color=BAND, zorder=0)
    for count in set(PAPER.values()):
        axes.axhline(count, color=MUTED, linewidth=0.9, linestyle=(0, (4, 2)))
        axes.text(len(sweep) + 0.4, count + 0.2, f"paper: {count}", ha="right", color=MUTED, fontsize=7.0)
    for k, (key, (label, colour, mark)) in enumerate(_SWEPT.items()):
        values = np.array([each.counts[key] for each in sweep])
        middle, across = np.median(values, axis=1), np.arange(len(sweep)) + (k - 1) * _ABREAST
        axes.vlines(across, values.min(axis=1), values.max(axis=1), color=colour, alpha=0.5, linewidth=1.4)
        axes.plot(across, middle, mark, color=colour, markersize=3.5, label=label)
    titles = [f"{each.friction}\n{np.sum(each.in_bands)}/{len(each.in_bands)}" for each in sweep]
    axes.set_xticks(range(len(sweep)), titles)
    axes.set_xlim(-0.6, len(sweep) + 0.4)
    axes.grid(visible=False, axis="x")
    axes.set(xlabel="friction coefficient, and stops with all three counts in the bands", ylabel="actuations")
    title_and_legend(axes, "Valve actuations in one stop: median and range over seeds", 3)
    from_zero(axes, across=False)
