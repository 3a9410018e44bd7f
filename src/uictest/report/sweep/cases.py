"""The cases of a sweep in summary.parquet, read in batches."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.core.document import Cell
from uictest.core.measures import column_unit
from uictest.core.units import SIZES
from uictest.report.sweep import SUMMARY
from uictest.report.sweep.result import OutcomeCount, SweepResult
from uictest.report.sweep.values import DrawnInterval
from uictest.report.workbook import Rows

if TYPE_CHECKING:
    import pyarrow as pa

_AT_ONCE: Final = 65_536
_ROWS_AT_ONCE: Final = 1024


@dataclass(frozen=True, slots=True)
class ReportedColumns:
    """A measure that reports show, in its unit: the largest of some columns of the rows."""

    name: str
    unit: str
    columns: tuple[str, ...]

    def of(self, table: pa.Table) -> NDArray[np.float64]:
        """Return the measure of each row, NaN where it has no value."""
        largest: NDArray[np.float64] = np.fmax.reduce([_numbers(table, name) for name in self.columns])
        # A column of a pure number may be shown in per cent.
        pure = column_unit(self.columns[0]) == "1"
        return largest / SIZES[self.unit] if pure and self.unit != "1" else largest


def reported_columns(result: SweepResult) -> list[ReportedColumns]:
    """Return the measures of a result that rows have: those of which it has the range."""
    return [
        ReportedColumns(each.measure, each.unit, each.columns) for each in result.measures if each.columns
    ]


@dataclass(frozen=True, slots=True)
class SummaryRows:
    """The summary of a sweep in its folder."""

    folder: Path

    @property
    def exists(self) -> bool:
        """Whether the folder has a summary."""
        return (self.folder / SUMMARY).is_file()

    def tables(self, columns: Sequence[str]) -> Iterator[pa.Table]:
        """Yield the rows in batches, with these columns. Raises OSError, ValueError where one is missing."""
        import pyarrow as pa
        import pyarrow.parquet as pq

        with pq.ParquetFile(self.folder / SUMMARY) as summary:
            missing = [name for name in columns if name not in summary.schema_arrow.names]
            if missing:
                raise ValueError(f"{self.folder / SUMMARY}: no column {missing[0]!r}")
            for batch in summary.iter_batches(_AT_ONCE, columns=list(columns)):
                yield pa.Table.from_batches([batch])

    def table(self) -> Rows:
        """Return all columns, and the rows as they are read. Raises OSError, ValueError where none can be."""
        import pyarrow.parquet as pq

        with pq.ParquetFile(self.folder / SUMMARY) as summary:
            return Rows(summary.schema_arrow.names, self._rows(), summary.metadata.num_rows, SUMMARY)

    def _rows(self) -> Iterator[dict[str, Cell]]:
        import pyarrow.parquet as pq

        with pq.ParquetFile(self.folder / SUMMARY) as summary:
            for batch in summary.iter_batches(_ROWS_AT_ONCE):
                yield from batch.to_pylist()

    def columns_of(self, keys: Sequence[str], measures: Sequence[ReportedColumns]) -> list[str]:
        """Return the columns of parameters, verdicts and measures."""
        of_measures = (column for measure in measures for column in measure.columns)
        return list(dict.fromkeys([*map(_text_column, keys), "outcome", "met", *of_measures]))

    def bins(self, table: pa.Table, key: str, counts: Sequence[OutcomeCount]) -> NDArray[np.int64]:
        """Return which of the values that a parameter is counted by each row has."""
        values = [count.value for count in counts]
        if isinstance(values[0], DrawnInterval):
            inner = [value.low for value in values[1:] if isinstance(value, DrawnInterval)]
            return np.searchsorted(inner, self.numbers(table, key), side="right").astype(np.int64)
        import pyarrow as pa
        import pyarrow.compute as pc

        labels = pa.array([value.label for value in values])
        places = pc.index_in(table.column(_text_column(key)), value_set=labels)
        if places.null_count:
            raise ValueError(f"{self.folder / SUMMARY}: a value of {key} is not in the result of the sweep")
        bins: NDArray[np.int64] = places.to_numpy().astype(np.int64)
        return bins

    def numbers(self, table: pa.Table, key: str) -> NDArray[np.float64]:
        """Return the numbers of a parameter in the unit in which they are written."""
        import pyarrow.compute as pc

        texts = pc.replace_substring_regex(table.column(_text_column(key)), " .*$", "")
        numbers: NDArray[np.float64] = pc.cast(texts, "double").to_numpy()
        return numbers

    def verdicts(self, table: pa.Table) -> tuple[NDArray[np.bool_], NDArray[Any]]:
        """Return of each row whether it met its expectation, and its outcome."""
        met, outcomes = (table.column(name).to_numpy() for name in ("met", "outcome"))
        return met.astype(bool), outcomes.astype(str)


def _text_column(key: str) -> str:
    return f"parameters.{key}"


def _numbers(table: pa.Table, name: str) -> NDArray[np.float64]:
    numbers: NDArray[np.float64] = np.array(table.column(name).to_numpy(zero_copy_only=False), float)
    return numbers
