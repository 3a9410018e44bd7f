"""Differences of each setting from the rig with four calipers, each point and all of them together."""

from __future__ import annotations

from collections.abc import Sequence
from statistics import median
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from studies.figures.style import MUTED, SETTINGS, WIDTH

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_COLUMNS = 4
_TITLES = {"four-caliper": "four calipers"}
_EXPLANATION = """Difference from the rig with
four calipers; last line:
that rig against itself.

Tick: median of all
Dot: median of one point
Bar: eight tenths of all
Line: least to greatest

Pressure and force:
largest error of a stop"""
_ROW = 0.14
_MOST = (0.1, 0.9)
"""Quantiles between which the bar is thick; it is thin from the minimum to the maximum."""
_NOTE: Any = {"ha": "center", "color": MUTED, "fontsize": 7.0}


class _Measure(Protocol):
    @property
    def key(self) -> str: ...
    @property
    def title(self) -> str: ...
    @property
    def unit(self) -> str: ...


class _Difference(Protocol):
    @property
    def rig(self) -> str: ...
    @property
    def measure(self) -> str: ...
    @property
    def wheelset(self) -> int: ...
    @property
    def values(self) -> Sequence[float]: ...


def draw_train(differences: Sequence[_Difference], measures: Sequence[_Measure], figure: Figure) -> None:
    """Draw a panel for each measure; repeats and wheelsets of all points together."""
    figure.set_size_inches(WIDTH, 4.3)
    rows = -(-len(measures) // _COLUMNS)
    panels = figure.subplots(rows, _COLUMNS, sharey=True, squeeze=False)
    for axes, measure in zip(panels.flat, measures, strict=False):
        _draw_measure(axes, [each for each in differences if each.measure == measure.key], measure)
    for axes in list(panels.flat)[len(measures) :]:
        axes.set_axis_off()
    panels[-1][-1].text(0.0, 1.0, _EXPLANATION, transform=panels[-1][-1].transAxes, va="top", color=MUTED)
    first = panels[0][0]
    first.set_yticks(range(len(SETTINGS)), [_TITLES.get(name, name) for name in SETTINGS])
    first.invert_yaxis()


def _draw_measure(axes: Axes, differences: Sequence[_Difference], measure: _Measure) -> None:
    axes.axvline(0.0, color=MUTED, linewidth=0.8)
    for row, (rig, colour) in enumerate(SETTINGS.items()):
        of_rig = [each for each in differences if each.rig == rig]
        values = [value for each in of_rig for value in each.values]
        if not values:
            continue
        axes.plot([min(values), max(values)], [row, row], color=colour, alpha=0.4, linewidth=1.0)
        axes.plot(np.quantile(values, _MOST), [row, row], color=colour, alpha=0.3, linewidth=4.5)
        medians = [median(each.values) for each in of_rig]
        axes.plot(medians, [row] * len(medians), "o", color=colour, alpha=0.4, markersize=2.8, mew=0.0)
        axes.plot([median(values)] * 2, [row - 0.32, row + 0.32], color=colour, linewidth=2.0)
    axes.grid(visible=False, axis="y")
    axes.set(title=measure.title, xlabel=measure.unit or "number")
    axes.tick_params(axis="y", length=0)


def draw_wheelsets(differences: Sequence[_Difference], measures: Sequence[_Measure], figure: Figure) -> None:
    """Draw a panel for each measure of wheelsets: a group of settings for each wheelset."""
    figure.set_size_inches(WIDTH, 4.6)
    panels = figure.subplots(2, 2, squeeze=False)
    for axes, measure in zip(panels.flat, measures, strict=True):
        of = [each for each in differences if each.measure == measure.key]
        axes.axhline(0.0, color=MUTED, linewidth=0.8)
        for k, (rig, colour) in enumerate(SETTINGS.items()):
            shift = (k - (len(SETTINGS) - 1) / 2.0) * _ROW
            _draw_rig(axes, [each for each in of if each.rig == rig], shift, colour)
        axes.set_xticks(range(1, 5), [f"wheelset {n}" for n in range(1, 5)])
        axes.set_xlim(0.5, 4.5)
        axes.grid(visible=False, axis="x")
        axes.set(title=measure.title, ylabel=measure.unit or "number")
    for axes in panels[1]:
        axes.set_ylim(bottom=0.0)
        axes.annotate("has the\ncaliper", (1.0, 0.05), xycoords=("data", "axes fraction"), **_NOTE)
    handles = [
        panels[0][0].plot([], [], color=colour, linewidth=3.0, label=_TITLES.get(rig, rig))[0]
        for rig, colour in SETTINGS.items()
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles))


def _draw_rig(axes: Axes, differences: Sequence[_Difference], shift: float, colour: str) -> None:
    for wheelset in sorted({each.wheelset for each in differences}):
        values = [value for each in differences if each.wheelset == wheelset for value in each.values]
        across = wheelset + shift
        axes.plot([across, across], [min(values), max(values)], color=colour, alpha=0.4, linewidth=1.0)
        axes.plot([across, across], np.quantile(values, _MOST), color=colour, alpha=0.35, linewidth=3.5)
        middle = median(values)
        axes.plot([across - 0.05, across + 0.05], [middle, middle], color=colour, linewidth=2.0)
