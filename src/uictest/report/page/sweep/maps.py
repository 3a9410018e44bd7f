"""Maps of two parameters as tables: the cases met, and measures that have no lines, by colour and in words.

The colours of measures are viridis (N. Smith and S. van der Walt, 2015), which rises evenly in lightness,
also in grey and for colour-blind eyes; its anchors are those of Matplotlib: sixteen of them, evenly spaced.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from uictest.report.escaping import printable
from uictest.report.page.axis import axis_title
from uictest.report.sweep.map_cells import MapCells
from uictest.report.sweep.map_text import MOST_SHOWN, short_label
from uictest.report.sweep.result import MET
from uictest.report.sweep.sweep_sentences import share_words

_ROUNDING: Final = 1e-9
"""Of a number: smaller differences are rounding. Chosen: means are shown with four digits."""
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
    if cells.met.any() and not np.array_equal(cells.met, cells.cases):
        title = "Outcome" if _is_of_single_cases(cells) else "Cases met, %"
        shares = cells.met / np.where(cells.cases > 0, cells.cases, np.nan)
        maps.append(_map(cells, MET, title, _verdicts(cells, shares), stops))
    for name, means in cells.means.items() if with_measures else ():
        if np.isfinite(means).any():
            title = axis_title(name, units.get(name, "1"))
            title = f"mean {title}" if (cells.cases > 1).any() else title
            maps.append(_map(cells, name, title[0].upper() + title[1:], _means(means), stops))
    if not maps:
        return None
    name = f"{cells.rows.parameter} (down) against {cells.columns.parameter} (across)"
    others = [key for key in varied if key not in (cells.rows.parameter, cells.columns.parameter)]
    return PairOfParameters(name, maps, list(_notes(cells, others)))


def _is_of_single_cases(cells: MapCells) -> bool:
    return bool(cells.outcomes) and not (cells.cases > 1).any()


Shown = tuple[str, str, str]
"""Text, class and colour of a cell."""


def _verdicts(cells: MapCells, shares: NDArray[np.float64]) -> list[list[Shown]]:
    rows = []
    for row, own in enumerate(shares.tolist()):
        shown = []
        for column, share in enumerate(own):
            met, cases = int(cells.met[row, column]), int(cells.cases[row, column])
            text = _outcome(cells, row, column) if _is_of_single_cases(cells) else share_words(met, cases)
            tone = "mixed" if 0.0 < share < 1.0 else "all-met" if share == 1.0 else "none-met"
            shown.append((text, tone, "") if cases else ("", "no-case", ""))
        rows.append(shown)
    return rows


def _outcome(cells: MapCells, row: int, column: int) -> str:
    return next((name for name, counts in cells.outcomes.items() if counts[row, column]), "")


def _means(means: NDArray[np.float64]) -> list[list[Shown]]:
    scale, digits = ColourScale.of(means), max(_digits(means), 4)
    rows = []
    for own in means.tolist():
        colours = ["" if mean != mean else scale.colour(mean) for mean in own]
        rows.append(
            [
                (f"{mean:.{digits}g}", "light" if is_dark(colour) else "dark", colour)
                if colour
                else (NO_VALUE, "no-value", "")
                for mean, colour in zip(own, colours, strict=True)
            ]
        )
    return rows


def _digits(values: NDArray[np.float64]) -> int:
    """Return how many digits tell values of different colours apart: steps of a twentieth of their span."""
    known = values[np.isfinite(values)]
    span = float(np.ptp(known))
    if not span:
        return 0
    largest = math.floor(math.log10(np.abs(known).max()))
    return min(largest + 1 + math.ceil(math.log10(20.0 / span)), _MOST_DIGITS)


def _map(
    cells: MapCells,
    measure: str,
    title: str,
    shown: Sequence[Sequence[Shown]],
    stops: Mapping[tuple[int, int], str],
) -> ShownMap:
    down, across = cells.rows.parameter, cells.columns.parameter
    rows = []
    for row, group in enumerate(cells.rows.groups):
        own = []
        for column, (text, kind, colour) in enumerate(shown[row]):
            if not cells.cases[row, column]:
                text, kind, colour = "", "no-case", ""
            kinds = " ".join([kind, *boundaries(cells.verdicts, row, column)])
            own.append(
                ShownCell(text, kinds, colour, _detail(cells, row, column), stops.get((row, column), ""))
            )
        rows.append((short_label(group), own))
    names = ("-".join(printable(name).split()) for name in (measure, down, across))
    columns = list(map(short_label, cells.columns.groups))
    is_dense = len(columns) > MOST_SHOWN
    return ShownMap("-".join(("map", *names)), title, f"{down} ↓ {across} →", columns, rows, is_dense)


def boundaries(verdicts: NDArray[np.int8], row: int, column: int) -> Iterator[str]:
    """Yield the sides at which a cell borders one of the other verdict; -1 is neither.

    A side is that of the cell to the right of it, or below.
    """
    for side, before in (("turns-above", (row - 1, column)), ("turns-left", (row, column - 1))):
        if min(before) >= 0 and sorted((verdicts[before], verdicts[row, column])) == [0, 1]:
            yield side


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
        place = min(max(share, 0.0), 1.0) * (len(_VIRIDIS) - 1)
        before = min(int(place), len(_VIRIDIS) - 2)
        pairs = zip(_rgb(_VIRIDIS[before]), _rgb(_VIRIDIS[before + 1]), strict=True)
        return "#" + "".join(f"{round(low + (place - before) * (high - low)):02x}" for low, high in pairs)


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
