"""Two swept parameters against each other: counts and means in cells, folded to few, as lines of text."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.report.formats.text import wrapped_sentence
from uictest.report.sweep.cases import ReportedColumns, SummaryRows
from uictest.report.sweep.result import VALID, SweepMap, SweepResult
from uictest.report.sweep.values import DrawnInterval, SweptValue, WrittenValue, range_label
from uictest.report.words import measure_words

MOST_SHOWN: Final = 24
"""Most rows or columns of a map that is read as a whole; chosen."""
MOST_VALUES: Final = 60
"""Most rows or columns of the first map: with more, a cell on a page is a few pixels wide. Chosen."""
MOST_PARAMETERS: Final = 5
"""Parameters of which every pair is mapped: ten pairs. Chosen."""
Counts = NDArray[np.int64]
Fold = list[range]
"""Indices of the values that share a row or a column."""


def fold(values: int, most: int) -> Fold:
    """Return the indices of so many values in at most `most` groups, all but the last of the same size."""
    size = -(-values // most)
    return [range(first, min(first + size, values)) for first in range(0, values, size)]


@dataclass(frozen=True, slots=True)
class CellAxis:
    """The parameter along one side of a map; each entry of `groups` has the values of one row or column."""

    parameter: str
    groups: Sequence[Sequence[SweptValue]]

    @property
    def values(self) -> int:
        """Number of values."""
        return sum(map(len, self.groups))

    @property
    def is_folded(self) -> bool:
        """Whether any row or column stands for several values."""
        return self.values > len(self.groups)

    def place_of(self, text: str) -> int | None:
        """Return the row or column of a value as written, None where there is none."""
        written = WrittenValue(text)
        holding = (
            k
            for k, group in enumerate(self.groups)
            if any(_is_swept_value(value, written) for value in group)
        )
        # A number between two intervals belongs to the upper one.
        return max(holding, default=None)


def _is_swept_value(value: SweptValue, written: WrittenValue) -> bool:
    if isinstance(value, WrittenValue):
        return value == written
    return written.number is not None and value.low <= written.number <= value.high


def _cell_axis(parameter: str, values: Sequence[SweptValue], groups: Fold) -> CellAxis:
    return CellAxis(parameter, [values[group.start : group.stop] for group in groups])


@dataclass(frozen=True, slots=True)
class MapCells:
    """The cells of a map; all arrays have the shape (rows, columns).

    Args:
        rows: the parameter down.
        columns: the parameter across.
        cases: number of cases.
        met: number of cases that met their expectation.
        valid: number of cases that are valid tests.
        outcomes: number of cases by outcome; empty where only a result without them is known.
        means: mean of each measure over the cases that have it, NaN where none has.
    """

    rows: CellAxis
    columns: CellAxis
    cases: Counts
    met: Counts
    valid: Counts
    outcomes: Mapping[str, Counts]
    means: Mapping[str, NDArray[np.float64]]

    @property
    def verdicts(self) -> NDArray[np.int8]:
        """1 where all cases met their expectation, 0 where one did not, -1 where no case was judged."""
        skipped = self.outcomes.get("skipped", np.zeros_like(self.cases))
        judged = self.cases > skipped
        return np.where(judged, (self.met == self.cases).astype(np.int8), np.int8(-1))


def is_large(sweep_map: SweepMap) -> bool:
    """Return whether a map has more rows or columns than are shown."""
    return any(len(axis.values) > MOST_SHOWN for axis in (sweep_map.rows, sweep_map.columns))


def folded(sweep_map: SweepMap, most_rows: int = MOST_SHOWN, most_columns: int | None = None) -> MapCells:
    """Return a map with at most so many rows and columns (`most_rows` of both unless stated otherwise).

    A cell that stands for several has their cases; its mean is that of the cases in all of them.
    """
    rows = fold(len(sweep_map.rows.values), most_rows)
    columns = fold(len(sweep_map.columns.values), most_columns or most_rows)
    numbers = sweep_map.cases, sweep_map.met, sweep_map.valid or sweep_map.cases
    cases, met, valid = (np.array(counts, np.int64) for counts in numbers)
    means = np.array(sweep_map.means, float)
    if len(rows) < len(sweep_map.rows.values) or len(columns) < len(sweep_map.columns.values):
        known = np.where(np.isfinite(means), sweep_map.known or cases, 0)
        total, known = (
            _summed_cells(cells, rows, columns) for cells in (np.nan_to_num(means) * known, known)
        )
        means = total / np.where(known > 0, known, np.nan)
        cases, met, valid = (_summed_cells(counts, rows, columns) for counts in (cases, met, valid))
    row_axis, column_axis = (
        _cell_axis(axis.parameter, axis.values, groups)
        for axis, groups in ((sweep_map.rows, rows), (sweep_map.columns, columns))
    )
    return MapCells(row_axis, column_axis, cases, met, valid, {}, {sweep_map.measure: means})


def _summed_cells(cells: NDArray[Any], rows: Fold, columns: Fold) -> NDArray[Any]:
    by_row = np.add.reduceat(cells, [group.start for group in rows], axis=0)
    return np.add.reduceat(by_row, [group.start for group in columns], axis=1)


def cells_of_maps(maps: Sequence[SweepMap], measures: Sequence[ReportedColumns]) -> MapCells:
    """Return the cells of the maps of a result, which all have the same axes, and no outcomes."""
    names = {measure.columns: measure.name for measure in measures}
    cells = [folded(sweep_map, MOST_VALUES) for sweep_map in maps]
    means = {
        names.get((sweep_map.measure,), measure_words(sweep_map.measure)): own.means[sweep_map.measure]
        for sweep_map, own in zip(maps, cells, strict=True)
        if not sweep_map.shows_met
    }
    return replace(cells[0], means=means)


def mapped_pairs(result: SweepResult) -> list[tuple[str, str]]:
    """Return the pairs of parameters that are mapped: first that of the result's own maps."""
    keys = [key for key in result.varied if len(result.rates.get(key, ())) > 1]
    of_maps = [(sweep_map.rows.parameter, sweep_map.columns.parameter) for sweep_map in result.maps[:1]]
    of_maps = [pair for pair in of_maps if set(pair) <= set(result.rates)]
    others = combinations(keys[:MOST_PARAMETERS], 2)
    return [*of_maps, *(pair for pair in others if set(pair) not in map(set, of_maps))]


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
        _Sums(pair, tuple(fold(len(result.rates[key]), limit) for key in pair), measures)
        for pair, limit in zip(pairs, most, strict=True)
    ]
    rates = {key: result.rates[key] for key in keys}
    for table in rows.tables(rows.columns_of(rates, measures)):
        bins = {key: rows.bins(table, key, counts) for key, counts in rates.items()}
        met, outcomes = rows.verdicts(table)
        values = [measure.of(table) for measure in measures]
        for of_pair in sums:
            of_pair.add(bins, met, outcomes, values)
    return [of_pair.cells(result) for of_pair in sums]


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

    def add(self, bins: Mapping[str, Counts], met: Any, outcomes: Any, values: Iterable[Any]) -> None:
        """Add cases: the index of their value of each parameter, verdicts, outcomes, and each measure."""
        groups = [bins[key] // len(groups[0]) for key, groups in zip(self.pair, self.folds, strict=True)]
        cells = np.ravel_multi_index(groups, self.shape)
        self._met += self._counted(cells[met])
        for outcome in np.unique(outcomes).tolist():
            counts = self._counted(cells[outcomes == outcome])
            self._outcomes[outcome] = self._outcomes.get(outcome, self._zeros()) + counts
        for index, numbers in enumerate(values):
            known = np.isfinite(numbers)
            self._known[index] += self._counted(cells[known])
            self._sums[index] += self._counted(cells[known], numbers[known])

    def _counted(self, cells: Any, weights: Any = None) -> Any:
        size = int(np.prod(self.shape))
        return np.bincount(cells, weights, size).reshape(self.shape)

    def cells(self, result: SweepResult) -> MapCells:
        """Return the cells of the cases that were added."""
        rows, columns = (
            _cell_axis(key, [count.value for count in result.rates[key]], groups)
            for key, groups in zip(self.pair, self.folds, strict=True)
        )
        cases = np.sum([self._zeros(), *self._outcomes.values()], axis=0)
        valid = np.sum([self._outcomes.get(name, self._zeros()) for name in VALID], axis=0)
        means = {
            measure.name: total / np.where(known > 0, known, np.nan)
            for measure, total, known in zip(self.measures, self._sums, self._known, strict=True)
        }
        return MapCells(rows, columns, cases, self._met, valid, self._outcomes, means)


def short_label(values: Sequence[SweptValue]) -> str:
    """Return the label of the values of a row or a column, e.g. `0.10 … 0.14`."""
    first, last = values[0].label, values[-1].label
    return first if len(values) == 1 else f"{first} … {last}"


def map_lines(sweep_map: SweepMap, width: int | None) -> Iterator[str]:
    """Yield the map in lines of at most `width` characters, None for any width.

    A row or column that stands for several values is labelled by its first and its last value.
    """
    for most_columns in range(min(MOST_SHOWN, len(sweep_map.columns.values)), 0, -1):
        cells = folded(sweep_map, MOST_SHOWN, most_columns)
        table = list(_text_map_lines(cells, sweep_map))
        if width is None or max(map(len, table)) <= width:
            break
    shares = "share met (. all, 1-9 tenths, # none, ? no valid test)"
    what = shares if sweep_map.shows_met else f"mean {sweep_map.measure}"
    about = f"{what}: {sweep_map.rows.parameter} down, {sweep_map.columns.parameter} across"
    yield from wrapped_sentence(about, width)
    notes = [
        f"{axis.values} values of {axis.parameter} in {len(axis.groups)} {name}"
        for axis, name in ((cells.rows, "rows"), (cells.columns, "columns"))
        if axis.is_folded
    ]
    if notes:
        every = f"tables/map-{sweep_map.measure}.csv has every value"
        yield from wrapped_sentence(f"folded: {', '.join(notes)}; {every}", width)
    yield from table


def _text_map_lines(cells: MapCells, sweep_map: SweepMap) -> Iterator[str]:
    means, valid = cells.means[sweep_map.measure].tolist(), cells.valid.tolist()
    sign = _share_sign if sweep_map.shows_met else lambda mean, _: f"{mean:.4g}"
    texts = [
        ["" if np.isnan(mean) else sign(mean, tests) for mean, tests in zip(*of_row, strict=True)]
        for of_row in zip(means, valid, strict=True)
    ]
    labels = [range_label(values) for values in cells.rows.groups]
    heads = list(zip(*map(_column_head, cells.columns.groups), strict=True))
    lines = [("", head) for head in heads if any(head)] + list(zip(labels, texts, strict=True))
    widths = [max(map(len, column)) for column in zip(*(row for _, row in lines), strict=True)]
    margin = max(map(len, labels))
    for label, row in lines:
        line = [f"{label:>{margin}}", *(f"{cell:>{size}}" for cell, size in zip(row, widths, strict=True))]
        yield "  ".join(line).rstrip()


def _column_head(values: Sequence[SweptValue]) -> tuple[str, str]:
    """Return the two lines above a column: its first value, and its last where that is another."""
    first, last = values[0], values[-1]
    if isinstance(first, DrawnInterval) and isinstance(last, DrawnInterval):
        return first.low_text, f".. {last.high_text}"
    return first.label, "" if len(values) == 1 else f".. {last.label}"


def _share_sign(share: float, valid: int) -> str:
    if share == 0.0 and not valid:
        return "?"
    # Only what is whole is shown as whole: one case of a thousand that misses must be seen.
    return "#123456789."[0 if share == 0.0 else 10 if share == 1.0 else min(max(round(10.0 * share), 1), 9)]
