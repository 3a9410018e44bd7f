"""The heat maps of a sweep: for each pair of parameters, the cases met and every measure."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from uictest.report.escaping import printable
from uictest.report.page.axis import axis_title
from uictest.report.page.links import fragment
from uictest.report.page.sweep.cell_lines import CellLines, cell_lines
from uictest.report.page.sweep.colour_scale import CIVIDIS, VIRIDIS, ColourScale
from uictest.report.page.sweep.heat_plot import SIGNS, HeatPlot, heat_plot, marked
from uictest.report.sweep.map_cells import MapCells
from uictest.report.sweep.map_text import short_label
from uictest.report.sweep.result import MET
from uictest.report.sweep.sweep_sentences import share_words
from uictest.report.verdict_sentences import counted

_SIGN_WORDS: Final = {
    "error": "with an error",
    "inconclusive": "with an inconclusive case",
    "skipped": "with a case that is not judged",
    "mixed": "in which only some cases met their expectation",
}
_ROUNDING: Final = 1e-9
"""Of a number: smaller differences are rounding. Chosen: means are shown with four digits."""
_MOST_DIGITS: Final = 9
"""Digits beyond these are those of rounding. Chosen."""
NO_VALUE: Final = "–"  # noqa: RUF001 - a dash on paper


@dataclass(frozen=True, slots=True)
class HeatCell:
    """One cell as text: its value, its cases, and the fragment of the stop that it leads to, if any."""

    text: str
    detail: str
    stop: str = ""


@dataclass(frozen=True, slots=True)
class HeatMap:
    """One measure over one pair of parameters: drawn, and as a table.

    Args:
        anchor: `id` of its part of the page: follows from the measure and the keys alone.
        measure: name by which it is chosen.
        title: what the colours show, with its unit.
        heading: the same with the keys.
        plot: the drawing.
        columns: labels of the columns.
        rows: label and cells of each row.

    """

    anchor: str
    measure: str
    title: str
    heading: str
    plot: HeatPlot
    columns: Sequence[str]
    rows: Sequence[tuple[str, Sequence[HeatCell]]]

    @property
    def fragment(self) -> str:
        """What stands behind the `#` of a link to it."""
        return fragment(self.anchor)


@dataclass(frozen=True, slots=True)
class HeatMaps:
    """The maps of one pair of parameters, and lines of its measures where one has few values.

    `notes` say what its cells stand for, `signs` what marks mean.
    """

    down: str
    across: str
    maps: Sequence[HeatMap]
    notes: Sequence[str]
    signs: Sequence[tuple[str, str]]
    no_case: int
    has_boundary: bool
    uniform: str
    """What the map of cases met would say in every cell; empty where its cells differ."""
    lines: Sequence[CellLines] = ()

    @property
    def name(self) -> str:
        """The parameters in words."""
        # The first row of a list stands on top.
        direction = "down" if self.maps[0].plot.down.spacing == "listed" else "up"
        return f"{self.down} ({direction}) against {self.across} (across)"


def heat_maps(
    cells: MapCells,
    units: Mapping[str, str],
    stops: Mapping[tuple[int, int], str],
    logarithmic: Collection[str],
    varied: Sequence[str],
) -> HeatMaps:
    """Return the maps of a pair of parameters.

    Args:
        cells: the cells of the pair.
        units: the unit of each measure.
        stops: fragment of the drawn stop in the cell at a row and a column, if any.
        logarithmic: keys of the parameters whose axes are logarithmic.
        varied: keys of all parameters of the sweep.

    """
    maps = [_map_of_verdicts(cells, stops, logarithmic)]
    maps += [_map_of_measure(cells, name, units.get(name, "1"), stops, logarithmic) for name in cells.means]
    others = [key for key in varied if key not in (cells.rows.parameter, cells.columns.parameter)]
    return HeatMaps(
        cells.rows.parameter,
        cells.columns.parameter,
        maps,
        list(_notes(cells, others)),
        [
            (SIGNS[name], f"{counted(count, 'cell')} {_SIGN_WORDS[name]}")
            for name, chosen in marked(cells).items()
            if (count := int(chosen.sum()))
        ],
        int((cells.cases == 0).sum()),
        bool(maps[0].plot.boundary),
        _uniform(cells),
        list(cell_lines(cells, units, logarithmic)),
    )


def _uniform(cells: MapCells) -> str:
    if np.array_equal(cells.met, cells.cases):
        return "In every cell all cases met their expectation."
    return "" if cells.met.any() else "In no cell did a case meet its expectation."


def _map_of_verdicts(
    cells: MapCells, stops: Mapping[tuple[int, int], str], logarithmic: Collection[str]
) -> HeatMap:
    shares = 100.0 * cells.met / np.where(cells.cases > 0, cells.cases, np.nan)
    texts = [
        [share_words(*each) if each[1] else "" for each in zip(*row, strict=True)]
        for row in zip(cells.met.tolist(), cells.cases.tolist(), strict=True)
    ]
    scale = ColourScale(CIVIDIS, 0.0, 100.0)
    shown = heat_plot(cells, shares, texts, scale, logarithmic)
    in_per_cent = [[f"{text} %" if text else "" for text in row] for row in texts]
    return _heat_map(cells, MET, "cases met, %", shown, list(_rows(cells, in_per_cent, stops)))


def _map_of_measure(
    cells: MapCells, name: str, unit: str, stops: Mapping[tuple[int, int], str], logarithmic: Collection[str]
) -> HeatMap:
    means = cells.means[name]
    digits = _digits(means)
    shown = heat_plot(
        cells, means, _texts(cells, name, lambda mean: _short(mean, digits)), _scale_of(means), logarithmic
    )
    title = axis_title(name, "" if unit == "1" else unit)
    if (cells.cases > 1).any():
        title = f"mean {title}"
    texts = _texts(cells, name, lambda mean: f"{mean:.{max(digits, 4)}g}")
    return _heat_map(cells, name, title, shown, list(_rows(cells, texts, stops)))


def _scale_of(values: NDArray[np.float64]) -> ColourScale:
    known = values[np.isfinite(values)]
    low, high = (float(known.min()), float(known.max())) if known.size else (0.0, 1.0)
    largest = max(abs(low), abs(high))
    # Means of equal numbers differ in their last digits, which are no difference to be coloured.
    is_one_value = high - low <= _ROUNDING * largest
    return ColourScale(VIRIDIS, low, low + (largest or 1.0) if is_one_value else high)


def _texts(cells: MapCells, name: str, text_of: Callable[[float], str]) -> list[list[str]]:
    """Return the means of a measure as texts; empty without a case."""
    return [
        [
            (text_of(mean) if mean == mean else NO_VALUE) if cases else ""
            for mean, cases in zip(*row, strict=True)
        ]
        for row in zip(cells.means[name].tolist(), cells.cases.tolist(), strict=True)
    ]


def _short(value: float, digits: int) -> str:
    """Return a value as it fits into a cell: whole from 100 on, else three digits; or in more digits."""
    if digits > 3:
        return f"{value:.{digits}g}"
    return f"{value:.0f}" if 100.0 <= abs(value) < 1e5 else f"{value:.3g}"


def _digits(values: NDArray[np.float64]) -> int:
    """Return how many digits tell values of different colours apart: steps of a twentieth of their span."""
    known = values[np.isfinite(values)]
    span = float(np.ptp(known)) if known.size else 0.0
    if not span:
        return 0
    largest = math.floor(math.log10(np.abs(known).max()))
    return min(largest + 1 + math.ceil(math.log10(20.0 / span)), _MOST_DIGITS)


def _heat_map(
    cells: MapCells,
    measure: str,
    title: str,
    plot: HeatPlot,
    rows: Sequence[tuple[str, Sequence[HeatCell]]],
) -> HeatMap:
    down, across = cells.rows.parameter, cells.columns.parameter
    heading = f"{title[0].upper()}{title[1:]}, over {down} and {across}"
    columns = list(map(short_label, cells.columns.groups))
    names = ("-".join(printable(name).split()) for name in (measure, down, across))
    return HeatMap("-".join(("map", *names)), measure, title, heading, plot, columns, rows)


def _rows(
    cells: MapCells, texts: list[list[str]], stops: Mapping[tuple[int, int], str]
) -> Iterator[tuple[str, list[HeatCell]]]:
    for row, group in enumerate(cells.rows.groups):
        yield (
            short_label(group),
            [
                HeatCell(texts[row][column], _detail(cells, row, column), stops.get((row, column), ""))
                for column in range(len(cells.columns.groups))
            ],
        )


def _detail(cells: MapCells, row: int, column: int) -> str:
    """Return the cases of a cell in words: how many met their expectation, and their outcomes."""
    count = int(cells.cases[row, column])
    if not count:
        return "no case"
    met = f"{int(cells.met[row, column])} of {count} met"
    outcomes = {name: int(counts[row, column]) for name, counts in cells.outcomes.items()}
    if count == 1:
        return next((name for name, number in outcomes.items() if number), met)
    others = [f"{number} {name}" for name, number in outcomes.items() if number and name != "pass"]
    return ", ".join([met, *others])


def _notes(cells: MapCells, others: Sequence[str]) -> Iterator[str]:
    if others:
        yield f"A cell has all cases with its two values, whatever their {', '.join(others)}."
    for axis in (cells.rows, cells.columns):
        if axis.is_folded:
            values = f"{axis.values} values of {axis.parameter}"
            yield f"Folded: neighbours of {values} share {len(axis.groups)} cells."
