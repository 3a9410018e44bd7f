"""The rows of a sweep as summary.csv and summary.parquet."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

from uictest.core import files
from uictest.report import csv_cell

if TYPE_CHECKING:
    import pyarrow as pa


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
