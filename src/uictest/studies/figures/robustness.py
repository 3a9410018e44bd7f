"""Actuations at every point of the neighbourhood: each stop a dot, the median a bar."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from statistics import median
from typing import TYPE_CHECKING

from uictest.studies.figures.style import SETTINGS, WIDTH, from_zero, title_and_legend

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_TITLES = {"four-caliper": "caliper in every module", "full": "full compensation", "none": "no compensation"}
_APART = 0.24


def draw(counts: Mapping[str, Mapping[str, Sequence[float]]], figure: Figure) -> None:
    """Draw a group of three columns of dots for each point; `counts` holds them by point and rig."""
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
