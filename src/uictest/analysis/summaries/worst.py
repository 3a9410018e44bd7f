"""The worst cases of a sweep, and all rows as summary.csv and summary.parquet."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Collection, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO, Final

import numpy as np

from uictest.core import files
from uictest.plans.scenario import Case
from uictest.plans.sweeps import Plan, in_survey_steps
from uictest.report import csv_cell
from uictest.running.chunked import surveyed_cases

if TYPE_CHECKING:
    import pyarrow as pa


MOST: Final = 12
"""Cases that a page draws: each takes about 160 kB."""
_NOT_SIMULATED: Final = ("error", "skipped")
"""Outcomes of cases that have nothing to draw."""


class WorstCases:
    """The first cases not met, then those with the narrowest margins; added chunk by chunk."""

    def __init__(self) -> None:
        self._worst = np.zeros((0, 3))
        self._surveyed: set[int] = set()

    def add(self, table: pa.Table) -> None:
        """Consider the rows of a chunk."""
        rows = np.column_stack([_numbers(table, name) for name in ("index", "narrowest_margin", "met")])
        simulated = ~np.isin(np.array(table.column("outcome").to_pylist()), _NOT_SIMULATED)
        rows = np.concatenate([self._worst, rows[simulated]])
        # Cases without any margin come last; among equals the order is that of the plan.
        self._worst = rows[np.lexsort(rows.T)][:MOST]
        self._surveyed = (self._surveyed | surveyed_cases(table)).intersection(self.indices())

    def indices(self) -> list[int]:
        """Return the indices of the cases, the worst first."""
        return [int(index) for index in self._worst[:, 0]]

    def surveyed(self) -> frozenset[int]:
        """Return the indices of those whose row is of a survey step."""
        return frozenset(self._surveyed)


def _numbers(table: pa.Table, name: str) -> Any:
    return np.array(table.column(name).to_numpy(zero_copy_only=False), float)


def full_cases(plan: Plan, indices: Sequence[int], surveyed: Collection[int] = ()) -> list[Case]:
    """Return cases of a plan with their whole scenarios; those that are `surveyed` in survey steps."""
    survey = in_survey_steps(plan) if surveyed else plan
    return [
        case
        for index in indices
        for case in (survey if index in surveyed else plan).cases(np.array([index], np.int64))
    ]


@contextlib.contextmanager
def summary_files(folder: Path, *, csv: bool = True) -> Iterator[Callable[[pa.Table], None]]:
    """Lend a function that appends rows to the files; they appear when the block ends. Raises OSError."""
    with contextlib.ExitStack() as opened:
        formats = {"parquet": _parquet_writer} | ({"csv": _csv_writer} if csv else {})
        new = {name: opened.enter_context(files.new_file(folder, f"summary.{name}")) for name in formats}
        with contextlib.ExitStack() as open_files:
            writers: list[Callable[[pa.Table], None]] = []

            def write(table: pa.Table) -> None:
                if not writers:
                    writers.extend(formats[name](open_files, new[name], table.schema) for name in formats)
                for write_table in writers:
                    write_table(table)

            yield write


def _parquet_writer(open_files: contextlib.ExitStack, file: BinaryIO, schema: pa.Schema) -> Any:
    from pyarrow.parquet import ParquetWriter

    return open_files.enter_context(ParquetWriter(file, schema, compression="zstd")).write_table


def _csv_writer(open_files: contextlib.ExitStack, file: BinaryIO, schema: pa.Schema) -> Any:
    from pyarrow.csv import CSVWriter, WriteOptions

    plain = without_formulas(schema.empty_table()).schema
    options = WriteOptions(quoting_style="needed", quoting_header="needed")
    writer = open_files.enter_context(CSVWriter(file, plain, write_options=options))
    return lambda table: writer.write_table(without_formulas(table))


def without_formulas(table: pa.Table) -> pa.Table:
    """Return the table with texts that no spreadsheet takes for formulas."""
    import pyarrow as pa

    for place, column in enumerate(table.schema):
        if pa.types.is_string(column.type):
            texts = table.column(place).to_pylist()
            guarded = {text: csv_cell(text) for text in set(texts)}
            cells = pa.array([guarded[text] for text in texts], pa.string())
            table = table.set_column(place, column.name, cells)
    return table
