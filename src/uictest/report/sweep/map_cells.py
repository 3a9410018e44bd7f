"""Two swept parameters against each other, cell by cell: cases by outcome, and means of measures."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.report.sweep.cases import ReportedColumns, SummaryRows
from uictest.report.sweep.map_text import MOST_SHOWN, Fold, fold, folded
from uictest.report.sweep.result import SweepMap, SweepResult
from uictest.report.sweep.sweep_sentences import measure_words
from uictest.report.sweep.values import SweptValue, WrittenValue

MOST_VALUES: Final = 60
"""Most rows or columns of the first map: with more, a cell on a page is a few pixels wide. Chosen."""

MOST_PARAMETERS: Final = 5
"""Parameters of which every pair is mapped: ten pairs. Chosen."""

Counts = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class CellAxis:
    """The parameter along one side of a map; each entry of `groups` has the values of one row or column."""

    parameter: str
    groups: Sequence[Sequence[SweptValue]]

    @property
    def values(self) -> int:
        """Number of values."""
        return sum(map(len, self.groups))

    def place_of(self, text: str) -> int | None:
        """Return the row or column of a value as written, None where there is none."""
        written = WrittenValue(text)
        places = (k for k, group in enumerate(self.groups) if any(_holds(value, written) for value in group))
        # A number between two intervals belongs to the upper one.
        return max(places, default=None)

    @property
    def is_folded(self) -> bool:
        """Whether any row or column stands for several values."""
        return self.values > len(self.groups)


def _holds(value: SweptValue, written: WrittenValue) -> bool:
    if isinstance(value, WrittenValue):
        return value == written
    return written.number is not None and value.low <= written.number <= value.high


@dataclass(frozen=True, slots=True)
class MapCells:
    """The cells of a map; all arrays have the shape (rows, columns).

    Args:
        rows: the parameter down.
        columns: the parameter across.
        cases: number of cases.
        met: number of cases that met their expectation.
        outcomes: number of cases by outcome; empty where only a result without them is known.
        means: mean of each measure over the cases that have it, NaN where none has.

    """

    rows: CellAxis
    columns: CellAxis
    cases: Counts
    met: Counts
    outcomes: Mapping[str, Counts]
    means: Mapping[str, NDArray[np.float64]]

    @property
    def verdicts(self) -> NDArray[np.int8]:
        """1 where all cases met their expectation, 0 where one did not, -1 where no case was judged."""
        skipped = self.outcomes.get("skipped", np.zeros_like(self.cases))
        judged = self.cases > skipped
        return np.where(judged, (self.met == self.cases).astype(np.int8), np.int8(-1))


def cells_of_maps(maps: Sequence[SweepMap], measures: Sequence[ReportedColumns]) -> MapCells:
    """Return the cells of the maps of a result, which all have the same axes, and no outcomes."""
    names = {measure.columns: measure.name for measure in measures}
    shown = {
        names.get((each.measure,), measure_words(each.measure)): folded(each, MOST_VALUES) for each in maps
    }
    first, own = maps[0], next(iter(shown.values()))
    means = {
        name: np.array(each.means, float)
        for (name, each), of in zip(shown.items(), maps, strict=True)
        if not of.shows_met
    }
    rows, columns = CellAxis(first.rows.parameter, own.rows), CellAxis(first.columns.parameter, own.columns)
    return MapCells(rows, columns, np.array(own.cases), np.array(own.met), {}, means)


def mapped_pairs(result: SweepResult) -> list[tuple[str, str]]:
    """Return the pairs of parameters that are mapped: first that of the result's own maps."""
    keys = [key for key in result.varied if len(result.rates.get(key, ())) > 1]
    own = [(each.rows.parameter, each.columns.parameter) for each in result.maps[:1]]
    own = [pair for pair in own if set(pair) <= set(result.rates)]
    others = combinations(keys[:MOST_PARAMETERS], 2)
    return [*own, *(pair for pair in others if set(pair) not in map(set, own))]


def map_cells(
    result: SweepResult,
    rows: SummaryRows,
    pairs: Sequence[tuple[str, str]],
    measures: Sequence[ReportedColumns],
) -> list[MapCells]:
    """Return the cells of each pair of parameters, summed over the rows of a summary.

    Raises OSError, and ValueError where a row has a value that the result does not have.
    """
    keys = list(dict.fromkeys(key for pair in pairs for key in pair))
    most = [MOST_VALUES, *(MOST_SHOWN for _ in pairs[1:])]
    sums = [
        _Sums(pair, tuple(fold(len(result.rates[key]), each) for key in pair), measures)
        for pair, each in zip(pairs, most, strict=True)
    ]
    for table in rows.tables(rows.columns_of(keys, measures)):
        bins = {key: rows.bins(table, key, result.rates[key]) for key in keys}
        met, outcomes = rows.verdicts(table)
        figures = [measure.of(table) for measure in measures]
        for each in sums:
            each.add(bins, met, outcomes, figures)
    return [each.cells(result) for each in sums]


@dataclass
class _Sums:
    """Sums over the cells of one map."""

    pair: tuple[str, str]
    folds: tuple[Fold, ...]
    measures: Sequence[ReportedColumns]
    shape: tuple[int, ...] = field(init=False)
    _met: Counts = field(init=False)
    _outcomes: dict[str, Counts] = field(default_factory=dict)
    _sums: list[NDArray[np.float64]] = field(init=False)
    _known: list[Counts] = field(init=False)

    def __post_init__(self) -> None:
        self.shape = tuple(map(len, self.folds))
        self._met = self._zeros()
        self._sums = [np.zeros(self.shape) for _ in self.measures]
        self._known = [self._zeros() for _ in self.measures]

    def _zeros(self) -> Counts:
        return np.zeros(self.shape, np.int64)

    def add(self, bins: Mapping[str, Counts], met: Any, outcomes: Any, figures: Iterable[Any]) -> None:
        """Add cases: the number of their value of each parameter, verdicts, outcomes, and each measure."""
        places = [bins[key] // len(each[0]) for key, each in zip(self.pair, self.folds, strict=True)]
        cells = np.ravel_multi_index(places, self.shape)
        self._met += self._counted(cells[met])
        for outcome in np.unique(outcomes).tolist():
            counts = self._counted(cells[outcomes == outcome])
            self._outcomes[outcome] = self._outcomes.get(outcome, self._zeros()) + counts
        for place, values in enumerate(figures):
            known = np.isfinite(values)
            self._known[place] += self._counted(cells[known])
            self._sums[place] += self._counted(cells[known], values[known])

    def _counted(self, cells: Any, weights: Any = None) -> Any:
        size = int(np.prod(self.shape))
        return np.bincount(cells, weights, size).reshape(self.shape)

    def cells(self, result: SweepResult) -> MapCells:
        """Return the cells of the cases that were added."""
        values = [[count.value for count in result.rates[key]] for key in self.pair]
        rows, columns = (
            CellAxis(key, [own[each.start : each.stop] for each in places])
            for key, own, places in zip(self.pair, values, self.folds, strict=True)
        )
        cases = np.sum([self._zeros(), *self._outcomes.values()], axis=0)
        return MapCells(rows, columns, cases, self._met, self._outcomes, dict(self._means()))

    def _means(self) -> Iterator[tuple[str, NDArray[np.float64]]]:
        for measure, total, known in zip(self.measures, self._sums, self._known, strict=True):
            yield measure.name, total / np.where(known > 0, known, np.nan)
