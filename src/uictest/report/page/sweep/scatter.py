"""Cases of a sampled sweep as points: parameters and measures; of many cases some are chosen."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from uictest.report.sweep.cases import SummaryRows, reported_columns
from uictest.report.sweep.result import SweepResult
from uictest.report.sweep.values import DrawnInterval
from uictest.report.verdict_sentences import outcome_word

if TYPE_CHECKING:
    import pyarrow as pa


MOST_POINTS: Final = 1000
"""Points that a page shows: more hide each other. Chosen."""


@dataclass(frozen=True, slots=True)
class PointNumbers:
    """A parameter or measure of every point, NaN where a case has none."""

    name: str
    unit: str
    numbers: NDArray[np.float64]
    logarithmic: bool = False


@dataclass(frozen=True, slots=True)
class Scatter:
    """Points of a sample.

    Args:
        cases: number of cases that they are chosen from.
        added: number of points that were asked for, besides those chosen at random.
        ids: of the cases.
        words: verdict of each in a word.
        all_words: number of all cases with each word.
        parameters: drawn ones first.
        measures: those of the reports.
        left_out: keys of parameters whose values are no numbers of one unit.

    """

    cases: int
    added: int
    ids: Sequence[str]
    words: Sequence[str]
    all_words: Mapping[str, int]
    parameters: Sequence[PointNumbers]
    measures: Sequence[PointNumbers]
    left_out: Sequence[str]


def is_sampled(result: SweepResult) -> bool:
    """Return whether any parameter was drawn from a distribution of numbers."""
    return any(_is_drawn(result, key) for key in result.rates)


def scatter(result: SweepResult, rows: SummaryRows, wanted: Collection[str]) -> Scatter:
    """Return the points of a sampled sweep.

    Args:
        result: of the sweep.
        rows: its summary.
        wanted: ids of cases that are points in any case.

    Raises:
        OSError: the summary cannot be read.
        ValueError: it lacks a column.

    """
    measures, keys = reported_columns(result), _number_keys(result)
    points = _Points(chosen_rows(result.cases), wanted)
    columns = ["id", *rows.columns_of(keys, measures)]
    parts = [points.chosen(table) for table in rows.tables(columns)]
    tables = [part for part in parts if part.num_rows]
    return Scatter(
        points.cases,
        points.added,
        [text for table in tables for text in table.column("id").to_pylist()],
        [word for table in tables for word in _words(table)],
        points.words,
        [_parameter(result, rows, key, tables) for key in keys],
        [
            PointNumbers(
                each.name, each.unit.removeprefix("1"), np.concatenate([each.of(table) for table in tables])
            )
            for each in measures
        ],
        [key for key in result.rates if key not in keys],
    )


def chosen_rows(cases: int, most: int = MOST_POINTS) -> NDArray[np.int64]:
    """Return which rows of so many are shown, in order: all, or as many as `most` chosen at random.

    Every k-th row would not do: those of a Sobol' sequence lie unevenly in its space for any k. The choice
    is the same in every report of a sweep.
    """
    if cases <= most:
        return np.arange(cases)
    return np.sort(np.random.default_rng(0).choice(cases, most, replace=False, shuffle=False))


class _Points:
    """Takes rows, batch by batch, and counts all of them by verdict."""

    def __init__(self, chosen: NDArray[np.int64], wanted: Collection[str]) -> None:
        self.cases, self.added = 0, 0
        self.words: Counter[str] = Counter()
        self._chosen, self._wanted = chosen, list(wanted)

    def chosen(self, table: pa.Table) -> pa.Table:
        """Return the rows of a batch that are points."""
        import pyarrow as pa
        import pyarrow.compute as pc

        by_chance = np.isin(self.cases + np.arange(table.num_rows), self._chosen)
        wanted = pc.is_in(table.column("id"), value_set=pa.array(self._wanted, pa.string())).to_numpy()
        self.cases += table.num_rows
        self.added += int(np.count_nonzero(wanted & ~by_chance))
        self.words.update(_counted_words(table))
        return table.filter(pa.array(by_chance | wanted.astype(bool)))


def _words(table: pa.Table) -> Iterator[str]:
    for outcome, met in zip(*(table.column(name).to_pylist() for name in ("outcome", "met")), strict=True):
        yield outcome_word(outcome, met=met)


def _counted_words(table: pa.Table) -> Counter[str]:
    counts: Counter[str] = Counter()
    for row in table.group_by(["outcome", "met"]).aggregate([([], "count_all")]).to_pylist():
        counts[outcome_word(row["outcome"], met=row["met"])] += row["count_all"]
    return counts


def _parameter(result: SweepResult, rows: SummaryRows, key: str, tables: Sequence[pa.Table]) -> PointNumbers:
    numbers = [rows.numbers(table, key) for table in tables]
    unit = result.rates[key][0].value.unit
    return PointNumbers(key, unit, np.concatenate(numbers), key in result.logarithmic)


def _number_keys(result: SweepResult) -> list[str]:
    """Return the keys whose values are different numbers of one unit, drawn ones first."""
    keys = [key for key in result.rates if _has_numbers(result, key)]
    return sorted(keys, key=lambda key: not _is_drawn(result, key))


def _has_numbers(result: SweepResult, key: str) -> bool:
    values = [count.value for count in result.rates[key]]
    numbers, units = {value.number for value in values}, {value.unit for value in values}
    return None not in numbers and len(numbers) > 1 and len(units) == 1


def _is_drawn(result: SweepResult, key: str) -> bool:
    return any(isinstance(count.value, DrawnInterval) for count in result.rates[key])
