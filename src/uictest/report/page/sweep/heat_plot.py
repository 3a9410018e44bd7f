"""A heat map, drawn: coloured cells, the boundary of the verdict, marks, and the colour bar."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.report.page.axis import Tick
from uictest.report.page.sweep.cell_axis import NumberAxis, PlacedCells, label_pixels, placed_cells
from uictest.report.page.sweep.colour_scale import ColourScale
from uictest.report.sweep.map_cells import MapCells

WIDTH: Final = 480
_RIGHT, _TOP = 392, 26
_BAR_LEFT, _BAR_RIGHT = 404, 416
_MOST_MARGIN = 150
_LETTER: Final = 0.64
"""Width of a figure over the size of its letters."""
_SMALLEST_TEXT, _LARGEST_TEXT, _SIGN = 7.0, 10.5, 7.0
SIGNS: Final = {"error": "×", "inconclusive": "?", "skipped": "○", "mixed": "◐"}  # noqa: RUF001 - signs
"""What stands in a cell in which some case has this outcome, or only some met their expectation."""


@dataclass(frozen=True, slots=True)
class CellText:
    """A text inside the map; on a dark colour it is light."""

    x: float
    y: float
    text: str
    light: bool
    size: float


@dataclass(frozen=True, slots=True)
class HeatPlot:
    """A heat map in pixels.

    Args:
        across: the columns.
        down: the rows.
        fills: paths of the cells of each colour.
        no_case: path of the cells without a case.
        no_value: path of the cells whose cases lack the measure.
        boundary: path between cells in which all cases met their expectation and those in which one did not.
        texts: values, where they have room.
        signs: marks of mixed cells and of outcomes.
        bar: paths of the colour bar, as `fills`.
        bar_ticks: where its labels stand.

    """

    across: PlacedCells
    down: PlacedCells
    fills: Mapping[str, str]
    no_case: str
    no_value: str
    boundary: str
    texts: Sequence[CellText]
    signs: Sequence[CellText]
    bar: Sequence[tuple[str, float, float]]
    bar_ticks: Sequence[Tick]
    left: float
    bottom: float
    height: float
    width: int = WIDTH
    right: float = _RIGHT
    top: float = _TOP
    bar_left: float = _BAR_LEFT
    bar_right: float = _BAR_RIGHT


def heat_plot(
    cells: MapCells,
    values: NDArray[np.float64],
    labels: Sequence[Sequence[str]],
    scale: ColourScale,
    logarithmic: Collection[str],
) -> HeatPlot:
    """Return a map drawn.

    Args:
        cells: the cells.
        values: the value of each, NaN where there is none.
        labels: the same as texts short enough for cells.
        scale: colours of the values.
        logarithmic: keys of the parameters whose axes are logarithmic.

    """
    rows = len(cells.rows.groups)
    bottom = _TOP + float(min(max(22 * rows, 200), 340))
    down = placed_cells(cells.rows, logarithmic, bottom, _TOP, upright=True)
    left = min(label_pixels(down.ticks) + 12, _MOST_MARGIN)
    across = placed_cells(cells.columns, logarithmic, left, _RIGHT)
    below = 0.5 * label_pixels(across.ticks) + 14 if across.slanted else 16
    signs = list(_signs(cells, values, scale, across, down))
    return HeatPlot(
        across,
        down,
        _fills(cells, values, scale, across, down),
        _outline(cells.cases == 0, across, down),
        _outline((cells.cases > 0) & ~np.isfinite(values), across, down),
        boundary_path(cells.verdicts, across, down),
        list(_texts(labels, values, scale, across, down, _SIGN if signs else 0.0)),
        signs,
        list(_bar(scale, bottom)),
        NumberAxis(scale.low, scale.high, bottom, _TOP).tick_marks(6),
        left,
        bottom,
        bottom + below + 22,
    )


def boundary_path(verdicts: NDArray[Any], across: PlacedCells, down: PlacedCells) -> str:
    """Return the lines between neighbouring cells of which one is met (1) and the other is not (0)."""
    lines = []
    for row, column in _changes(verdicts[:, :-1], verdicts[:, 1:]):
        upper, lower = down.span(row)
        lines.append(f"M{across.edges[column + 1]:.1f} {upper:.1f}V{lower:.1f}")
    for row, column in _changes(verdicts[:-1], verdicts[1:]):
        first, last = across.span(column)
        lines.append(f"M{first:.1f} {down.edges[row + 1]:.1f}H{last:.1f}")
    return "".join(lines)


def marked(cells: MapCells) -> dict[str, NDArray[np.bool_]]:
    """Return for each sign of :data:`SIGNS` which cells have it."""
    nothing = np.zeros_like(cells.cases)
    of_outcomes = {
        name: cells.outcomes.get(name, nothing) > 0 for name in ("error", "inconclusive", "skipped")
    }
    return {**of_outcomes, "mixed": (cells.met > 0) & (cells.met < cells.cases)}


def _changes(before: NDArray[Any], after: NDArray[Any]) -> list[list[int]]:
    changes: list[list[int]] = np.argwhere((before >= 0) & (after >= 0) & (before != after)).tolist()
    return changes


def _fills(
    cells: MapCells, values: NDArray[np.float64], scale: ColourScale, across: PlacedCells, down: PlacedCells
) -> dict[str, str]:
    paths: dict[int, list[str]] = {}
    for row, column in np.argwhere((cells.cases > 0) & np.isfinite(values)).tolist():
        rectangle = _rectangle(row, column, across, down)
        paths.setdefault(scale.step(float(values[row, column])), []).append(rectangle)
    return {scale.colours[step]: "".join(each) for step, each in sorted(paths.items())}


def _outline(chosen: NDArray[np.bool_], across: PlacedCells, down: PlacedCells) -> str:
    return "".join(_rectangle(row, column, across, down) for row, column in np.argwhere(chosen).tolist())


def _rectangle(row: int, column: int, across: PlacedCells, down: PlacedCells) -> str:
    (first, last), (upper, lower) = across.span(column), down.span(row)
    return f"M{first:.1f} {upper:.1f}H{last:.1f}V{lower:.1f}H{first:.1f}z"


def _texts(
    labels: Sequence[Sequence[str]],
    values: NDArray[np.float64],
    scale: ColourScale,
    across: PlacedCells,
    down: PlacedCells,
    beside: float,
) -> Iterator[CellText]:
    """Yield the values in their cells, all of them or, where they have no room, none.

    `beside` is left free of the width of each cell, pixels.
    """
    size = _text_size(labels, across, down, beside)
    if size < _SMALLEST_TEXT:
        return
    for row, column in product(*map(range, values.shape)):
        if text := labels[row][column]:
            middle, height = sum(across.span(column)) / 2, sum(down.span(row)) / 2 + 0.36 * size
            yield CellText(middle, height, text, _is_dark(float(values[row, column]), scale), size)


def _text_size(
    labels: Sequence[Sequence[str]], across: PlacedCells, down: PlacedCells, beside: float
) -> float:
    """Return the largest size of letters, pixels, in which every label fits into its cell."""
    longest = [max(map(len, column), default=0) for column in zip(*labels, strict=True)]
    heights = [lower - upper for upper, lower in map(down.span, range(len(labels)))]
    by_width = [
        (abs(across.edges[k + 1] - across.edges[k]) - 3.0 - beside) / (_LETTER * length)
        for k, length in enumerate(longest)
        if length
    ]
    return min(*by_width, min(heights) / 1.3, _LARGEST_TEXT)


def _signs(
    cells: MapCells, values: NDArray[np.float64], scale: ColourScale, across: PlacedCells, down: PlacedCells
) -> Iterator[CellText]:
    """Yield the signs of each cell, in its upper right corner."""
    which = marked(cells)
    for row, column in np.argwhere(np.logical_or.reduce(list(which.values()))).tolist():
        text = "".join(SIGNS[name] for name, chosen in which.items() if chosen[row, column])
        (first, last), (upper, lower) = across.span(column), down.span(row)
        size = min(max(0.8 * min(last - first, lower - upper), 4.0), _SIGN)
        light = _is_dark(float(values[row, column]), scale)
        yield CellText(last - 1, upper + 0.9 * size, text, light, size)


def _is_dark(value: float, scale: ColourScale) -> bool:
    return value == value and scale.step(value) in scale.with_light_text


def _bar(scale: ColourScale, bottom: float) -> Iterator[tuple[str, float, float]]:
    """Yield the colours of the bar from below, with the pixels of their upper end and their height."""
    height = (bottom - _TOP) / scale.STEPS
    for number, colour in enumerate(scale.colours):
        yield colour, bottom - (number + 1) * height, height
