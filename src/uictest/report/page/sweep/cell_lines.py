"""A measure over one swept parameter, a line for each value of a second one."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from uictest.report.page.axis import Axis, Tick, axis_title, span
from uictest.report.page.sweep.cell_axis import spanned
from uictest.report.sweep.map_cells import CellAxis, MapCells
from uictest.report.sweep.map_text import short_label
from uictest.report.verdict_sentences import counted

MOST_LINES: Final = 6
"""Values of the second parameter: more lines cannot be told apart. Chosen."""
_LEFT, _RIGHT, _TOP, _BOTTOM = 52, 402, 26, 166


@dataclass(frozen=True, slots=True)
class CellLine:
    """The means at one value of the second parameter; points are x, y, in pixels, and their words."""

    label: str
    path: str
    points: Sequence[tuple[float, float, str]]


@dataclass(frozen=True, slots=True)
class CellLines:
    """One measure, drawn; every point is the mean of one cell of the map, so none mixes cases of others."""

    title: str
    x_title: str
    second: str
    lines: Sequence[CellLine]
    x_ticks: Sequence[Tick]
    y_ticks: Sequence[Tick]
    of_cases: str
    left: int = _LEFT
    right: int = _RIGHT
    top: int = _TOP
    bottom: int = _BOTTOM


def cell_lines(
    cells: MapCells, units: Mapping[str, str], logarithmic: Collection[str]
) -> Iterator[CellLines]:
    """Yield the lines of every measure of a pair of parameters that has few enough values of one of them.

    Args:
        cells: the cells of the pair.
        units: the unit of each measure.
        logarithmic: keys of the parameters whose axes are logarithmic.

    """
    if _is_line(cells.rows) and (numbers := _numbers(cells.columns)):
        second, first, turned = cells.rows, cells.columns, False
    elif _is_line(cells.columns) and (numbers := _numbers(cells.rows)):
        second, first, turned = cells.columns, cells.rows, True
    else:
        return
    counts = cells.cases.T if turned else cells.cases
    order = np.argsort(numbers)
    x = spanned(numbers, _LEFT, _RIGHT, logarithmic=first.parameter in logarithmic)
    x_title = axis_title(first.parameter, next(iter(_units(first))))
    n = f"; cells of {counted(int(counts.flat[0]), 'case')}" if len(set(counts.flat)) == 1 else ""
    for name, values in cells.means.items():
        means = (values.T if turned else values)[:, order]
        if not np.isfinite(means).any():
            continue
        y = Axis(*span([means.ravel()], ()), _BOTTOM, _TOP)
        places = [x.at(numbers[k]) for k in order]
        labels = [short_label(first.groups[k]) for k in order]
        unit = units.get(name, "1")
        yield CellLines(
            axis_title(name, "" if unit == "1" else unit),
            x_title + (", logarithmic" if x.logarithmic else ""),
            second.parameter,
            [
                _line(short_label(group), own, counts[row, order], places, labels, y)
                for row, (group, own) in enumerate(zip(second.groups, means, strict=True))
            ],
            x.tick_marks(6),
            y.tick_marks(5),
            n,
        )


def _is_line(axis: CellAxis) -> bool:
    return 2 <= len(axis.groups) <= MOST_LINES and not axis.is_folded


def _numbers(axis: CellAxis) -> list[float]:
    """Return the values of an axis; nothing where they are no numbers of one unit, or fewer than two."""
    values = [group[0].number for group in axis.groups]
    known = [value for value in values if value is not None]
    fit = len(known) == len(values) >= 2 and len(_units(axis)) == 1 and not axis.is_folded
    return known if fit else []


def _units(axis: CellAxis) -> set[str]:
    return {group[0].unit for group in axis.groups}


def _line(
    label: str,
    means: NDArray[np.float64],
    counts: NDArray[np.int64],
    places: Sequence[float],
    labels: Sequence[str],
    y: Axis,
) -> CellLine:
    """Return one line; where a cell has no value it has a gap."""
    path, points, drawing = "", [], False
    for at, mean, count, value in zip(places, means.tolist(), counts.tolist(), labels, strict=True):
        if mean != mean:
            drawing = False
            continue
        path += f"{'L' if drawing else 'M'}{at:.1f} {y.at(mean):.1f}"
        points.append((at, y.at(mean), f"{label}, {value}: {mean:.4g}, {counted(count, 'case')}"))
        drawing = True
    return CellLine(label, path, points)
