"""The rows of a sweep as summary.csv and summary.parquet."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

from uictest import files
from uictest.report import csv_cell

if TYPE_CHECKING:
    import pyarrow as pa


@contextlib.contextmanager
def summary_files(folder: Path) -> Iterator[Callable[[pa.Table], None]]:
    """Lend a function that appends rows to both files; they appear when the block ends. Raises OSError."""
    csv_path, parquet_path = (files.new_file(folder, f"summary.{suffix}") for suffix in ("csv", "parquet"))
    with csv_path as csv, parquet_path as parquet, contextlib.ExitStack() as open_files:
        writers: list[Any] = []

        def write(table: pa.Table) -> None:
            if not writers:
                writers.extend(_writers(open_files, csv, parquet, table.schema))
            writers[0].write_table(without_formulas(table))
            writers[1].write_table(table)

        yield write


def _writers(
    open_files: contextlib.ExitStack, csv: BinaryIO, parquet: BinaryIO, schema: pa.Schema
) -> list[Any]:
    from pyarrow.csv import CSVWriter, WriteOptions
    from pyarrow.parquet import ParquetWriter

    csv_schema = without_formulas(schema.empty_table()).schema
    options = WriteOptions(quoting_style="needed", quoting_header="needed")
    return [
        open_files.enter_context(CSVWriter(csv, csv_schema, write_options=options)),
        open_files.enter_context(ParquetWriter(parquet, schema, compression="zstd")),
    ]


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
