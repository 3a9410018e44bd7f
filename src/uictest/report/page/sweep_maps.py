"""Maps of two parameters as tables: the cases met, and measures that have no lines, by colour and in words.

The colours of measures are viridis (N. Smith and S. van der Walt, 2015), which rises evenly in lightness,
also in grey and for colour-blind eyes; its anchors are those of Matplotlib: sixteen of them, evenly spaced.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from uictest.report.page.plot import axis_title
from uictest.report.sweep.result import MET
from uictest.report.sweep.sweep_maps import MOST_SHOWN, MapCells, short_label
from uictest.report.sweep.sweep_sentences import share_words
from uictest.report.words import printable

_MOST_DIGITS: Final = 9
"""Digits beyond these are those of rounding. Chosen."""
NO_VALUE: Final = "–"  # noqa: RUF001 - a dash on paper


@dataclass(frozen=True, slots=True)
class ShownCell:
    """A cell: its value, classes, and colour; its cases in words, and the stop that it leads to, if any."""

    text: str
    kind: str
    colour: str
    detail: str
    stop: str = ""


@dataclass(frozen=True, slots=True)
class ShownMap:
    """One measure over a pair of parameters.

    Args:
        anchor: `id` of its part of the page: follows from the measure and the keys alone.
        title: what the cells show, with its unit.
        corner: the parameters down and across.
        columns: labels of the columns.
        rows: label and cells of each row.
        is_dense: its cells have no room for texts.

    """

    anchor: str
    title: str
    corner: str
    columns: Sequence[str]
    rows: Sequence[tuple[str, Sequence[ShownCell]]]
    is_dense: bool


@dataclass(frozen=True, slots=True)
class PairOfParameters:
    """The maps of a pair of parameters; `notes` say what its cells stand for."""

    name: str
    maps: Sequence[ShownMap]
    notes: Sequence[str]


def maps_of_pair(
    cells: MapCells,
    units: Mapping[str, str],
    stops: Mapping[tuple[int, int], str],
    varied: Sequence[str],
    *,
    with_measures: bool,
) -> PairOfParameters | None:
    """Return the maps of a pair of parameters; None where they would say the same in every cell.

    Args:
        cells: the cells of the pair.
        units: the unit of each measure.
        stops: fragment of the drawn stop in the cell at a row and a column, if any.
        varied: keys of all parameters of the sweep.
        with_measures: the measures as well as the cases met.

    """
    maps = []
    several = (cells.cases > 1).any()
    if cells.met.any() and not np.array_equal(cells.met, cells.cases):
        by_outcome = bool(cells.outcomes) and not several
        title = "Outcome" if by_outcome else "Cases met, %"
        maps.append(_map(cells, MET, title, _of_verdicts(cells, by_outcome=by_outcome), stops))
    for name, means in cells.means.items() if with_measures else ():
        if np.isfinite(means).any():
            title = axis_title(name, units.get(name, "1"))
            title = f"mean {title}" if several else title
            maps.append(_map(cells, name, title[0].upper() + title[1:], _of_means(means), stops))
    if not maps:
        return None
    rows, columns = cells.rows, cells.columns
    notes = []
    if others := [key for key in varied if key not in (rows.parameter, columns.parameter)]:
        notes.append(f"A cell has all cases with its two values, whatever their {', '.join(others)}.")
    for axis in (rows, columns):
        if axis.is_folded:
            values = f"{axis.values} values of {axis.parameter}"
            notes.append(f"Folded: neighbours of {values} share {len(axis.groups)} cells.")
    return PairOfParameters(f"{rows.parameter} (down) against {columns.parameter} (across)", maps, notes)


_ShownCell = tuple[str, str, str]
"""Text, class and colour of a cell."""


def _of_verdicts(cells: MapCells, *, by_outcome: bool) -> Callable[[int, int], _ShownCell]:
    """Return the painter of cells by the outcome of their only case, else by the share of cases met."""

    def shown(row: int, column: int) -> _ShownCell:
        met, cases = int(cells.met[row, column]), int(cells.cases[row, column])
        text = share_words(met, cases)
        if by_outcome:
            text = next((name for name, counts in cells.outcomes.items() if counts[row, column]), "")
        if not met:
            return text, "none-met" if cells.valid[row, column] else "no-test", ""
        return text, "all-met" if met == cases else "mixed", ""

    return shown


def _of_means(means: NDArray[np.float64]) -> Callable[[int, int], _ShownCell]:
    """Return the painter of cells by the mean of a measure."""
    scale = ColourScale.of(means)
    known = means[np.isfinite(means)]
    digits = 4
    if width := float(np.ptp(known)):
        # Values of different colours are told apart: steps of a twentieth of what they span.
        largest = math.floor(math.log10(np.abs(known).max()))
        digits = max(digits, min(largest + 1 + math.ceil(math.log10(20.0 / width)), _MOST_DIGITS))

    def shown(row: int, column: int) -> _ShownCell:
        mean = float(means[row, column])
        if math.isnan(mean):
            return NO_VALUE, "no-value", ""
        colour = scale.colour(mean)
        return f"{mean:.{digits}g}", "light" if is_dark(colour) else "dark", colour

    return shown


def _map(
    cells: MapCells,
    measure: str,
    title: str,
    shown: Callable[[int, int], _ShownCell],
    stops: Mapping[tuple[int, int], str],
) -> ShownMap:
    down, across = cells.rows.parameter, cells.columns.parameter
    columns = list(map(short_label, cells.columns.groups))
    rows = []
    for row, group in enumerate(cells.rows.groups):
        row_cells = []
        for column in range(len(columns)):
            text, kind, colour = shown(row, column) if cells.cases[row, column] else ("", "no-case", "")
            kinds = " ".join([kind, *boundaries(cells.verdicts, row, column)])
            detail, stop = _cell_detail(cells, row, column), stops.get((row, column), "")
            row_cells.append(ShownCell(text, kinds, colour, detail, stop))
        rows.append((short_label(group), row_cells))
    names = ("-".join(printable(name).split()) for name in (measure, down, across))
    is_dense = len(columns) > MOST_SHOWN
    return ShownMap("-".join(("map", *names)), title, f"{down} ↓ {across} →", columns, rows, is_dense)


def boundaries(verdicts: NDArray[np.int8], row: int, column: int) -> list[str]:
    """Return the sides at which a cell borders one of the other verdict; -1 is neither.

    A side is that of the cell to the right of it, or below.
    """
    neighbours = {"turns-above": (row - 1, column), "turns-left": (row, column - 1)}
    return [
        side
        for side, before in neighbours.items()
        if min(before) >= 0 and sorted((verdicts[before], verdicts[row, column])) == [0, 1]
    ]


def _cell_detail(cells: MapCells, row: int, column: int) -> str:
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


_ROUNDING: Final = 1e-9
"""Of a number: smaller differences are rounding. Chosen: means are shown with four digits."""
_VIRIDIS: Final = (
    *("#440154", "#481a6c", "#472f7d", "#414487", "#39568c", "#31688e", "#2a788e", "#23888e"),
    *("#1f988b", "#22a884", "#35b779", "#54c568", "#7ad151", "#a5db36", "#d2e21b", "#fde725"),
)
_LIGHT_TEXT_BELOW: Final = 0.179
"""Relative luminance at which black and white text have the same contrast (WCAG 2.1, 1.4.3)."""


@dataclass(frozen=True)
class ColourScale:
    """Colours from `low` to `high`."""

    low: float
    high: float

    @classmethod
    def of(cls, values: NDArray[np.float64]) -> ColourScale:
        """Return the scale that spans values; of equal ones all colours are the same."""
        known = values[np.isfinite(values)]
        low, high = float(known.min()), float(known.max())
        # Means of equal numbers differ in their last digits, which are no difference to be coloured.
        is_one_value = high - low <= _ROUNDING * max(abs(low), abs(high))
        return cls(low, low if is_one_value else high)

    def colour(self, value: float) -> str:
        """Return the colour of a value as `#rrggbb`."""
        share = (value - self.low) / (self.high - self.low) if self.high > self.low else 0.5
        position = min(max(share, 0.0), 1.0) * (len(_VIRIDIS) - 1)
        before = min(int(position), len(_VIRIDIS) - 2)
        pairs = zip(_rgb(_VIRIDIS[before]), _rgb(_VIRIDIS[before + 1]), strict=True)
        return "#" + "".join(f"{round(low + (position - before) * (high - low)):02x}" for low, high in pairs)


def is_dark(colour: str) -> bool:
    """Return whether white text stands out from a colour more than black."""
    return luminance(colour) < _LIGHT_TEXT_BELOW


def luminance(colour: str) -> float:
    """Return the relative luminance of a colour, 0 .. 1 (WCAG 2.1)."""
    channels = (channel / 255 for channel in _rgb(colour))
    red, green, blue = (c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels)
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def _rgb(colour: str) -> tuple[int, ...]:
    return tuple(int(colour[k : k + 2], 16) for k in (1, 3, 5))
