"""The cases of a sweep in summary.parquet, read in batches."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.core.measures import column_unit
from uictest.core.units import SIZES
from uictest.report.sweep import SUMMARY
from uictest.report.sweep.result import OutcomeCount, SweepResult
from uictest.report.sweep.values import DrawnInterval, interval_indices

if TYPE_CHECKING:
    import pyarrow as pa

_AT_ONCE: Final = 65_536


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

    def columns_of(
        self, rates: Mapping[str, Sequence[OutcomeCount]], measures: Sequence[ReportedColumns]
    ) -> list[str]:
        """Return the columns of verdicts, measures and the parameters that `rates` counts by their values."""
        columns = [
            _number_column(key) if isinstance(counts[0].value, DrawnInterval) else _text_column(key)
            for key, counts in rates.items()
        ]
        of_measures = (column for measure in measures for column in measure.columns)
        return list(dict.fromkeys([*columns, "outcome", "met", *of_measures]))

    def bins(self, table: pa.Table, key: str, counts: Sequence[OutcomeCount]) -> NDArray[np.int64]:
        """Return the index, for each row, of its value among those that a parameter is counted by."""
        values = [count.value for count in counts]
        intervals = [value for value in values if isinstance(value, DrawnInterval)]
        if intervals:
            return interval_indices(intervals, table.column(_number_column(key)).to_numpy())
        import pyarrow as pa
        import pyarrow.compute as pc

        labels = pa.array([value.label for value in values])
        places = pc.index_in(table.column(_text_column(key)), value_set=labels)
        if places.null_count:
            raise ValueError(f"{self.folder / SUMMARY}: a value of {key} is not in the result of the sweep")
        bins: NDArray[np.int64] = places.to_numpy().astype(np.int64)
        return bins

    def verdicts(self, table: pa.Table) -> tuple[NDArray[np.bool_], NDArray[Any]]:
        """Return of each row whether it met its expectation, and its outcome."""
        met, outcomes = (table.column(name).to_numpy() for name in ("met", "outcome"))
        return met.astype(bool), outcomes.astype(str)


def _text_column(key: str) -> str:
    return f"parameters.{key}"


def _number_column(key: str) -> str:
    return f"values.{key}"


def _numbers(table: pa.Table, name: str) -> NDArray[np.float64]:
    numbers: NDArray[np.float64] = np.array(table.column(name).to_numpy(zero_copy_only=False), float)
    return numbers
