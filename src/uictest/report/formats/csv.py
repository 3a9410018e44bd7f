"""Tables as CSV: comma, line feed, the keys of the columns first; missing numbers are empty cells."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from uictest.core.document import Cell, Column, Table
from uictest.report.words import csv_cell

if TYPE_CHECKING:
    import pyarrow as pa


def csv_text(table: Table) -> str:
    """Return a table as CSV."""
    return b"".join(csv_chunks(table)).decode()


def csv_chunks(table: Table) -> Iterator[bytes]:
    """Yield a table as CSV, piece by piece."""
    if isinstance(table.rows, ParquetRows):
        yield from table.rows.csv()
        return
    buffer = io.StringIO(newline="")
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(csv_cell(column.key) for column in table.for_programs)
    for record in table.records:
        writer.writerow(map(_cell, record.values()))
        yield buffer.getvalue().encode()
        buffer.seek(0)
        buffer.truncate()
    yield buffer.getvalue().encode()


def _cell(value: Cell) -> str:
    if value is None:
        return ""
    if isinstance(value, str):
        return csv_cell(value)
    return str(value).lower() if isinstance(value, bool) else repr(value)


_AT_ONCE: Final = 1024


@dataclass(frozen=True, slots=True)
class ParquetRows:
    """The rows of a Parquet file, as mappings from a column to its cell."""

    path: Path

    def __len__(self) -> int:
        """Return their number. Raises OSError."""
        import pyarrow.parquet as pq

        return int(pq.read_metadata(self.path).num_rows)

    def __iter__(self) -> Iterator[dict[str, Cell]]:
        """Iterate over the rows. Raises OSError, and ValueError where the file is damaged."""
        for batch in self._batches():
            yield from batch.to_pylist()

    def csv(self) -> Iterator[bytes]:
        """Yield the rows as CSV with a header, formulas guarded, faster than cell by cell."""
        from pyarrow.csv import CSVWriter, WriteOptions

        buffer, writer = io.BytesIO(), None
        for batch in self._batches():
            guarded = _without_formulas(batch)
            if writer is None:
                options = WriteOptions(quoting_style="needed", quoting_header="needed")
                writer = CSVWriter(buffer, guarded.schema, write_options=options)
            writer.write(guarded)
            yield buffer.getvalue()
            buffer.seek(0)
            buffer.truncate()

    def table(self, name: str) -> Table:
        """Return the table of all columns. Raises OSError, and ValueError where the file is damaged."""
        import pyarrow.parquet as pq

        columns: list[Column[Any]] = [Column(key=key) for key in pq.read_schema(self.path).names]
        return Table(columns, self, name=name, all_in=self.path.name)

    def _batches(self) -> Iterator[pa.RecordBatch]:
        import pyarrow.parquet as pq

        with pq.ParquetFile(self.path) as file:
            yield from file.iter_batches(_AT_ONCE)


def _without_formulas(batch: pa.RecordBatch) -> pa.RecordBatch:
    import pyarrow as pa

    columns = []
    for column in batch.columns:
        if pa.types.is_string(column.type):
            texts = column.to_pylist()
            guarded = {text: csv_cell(text) for text in set(texts) if text is not None}
            column = pa.array([guarded.get(text) for text in texts], pa.string())
        columns.append(column)
    return pa.RecordBatch.from_arrays(columns, names=batch.schema.names)
