"""Rows as CSV text: user text guarded, missing numbers as empty cells."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence
from typing import NamedTuple, Self

from uictest.report.escaping import csv_cell

Cell = str | float | int | bool | None


class Table(NamedTuple):
    """The columns of a table and its rows; a row may lack columns."""

    columns: Sequence[str]
    rows: Sequence[dict[str, Cell]]

    @classmethod
    def of(cls, rows: Sequence[dict[str, Cell]]) -> Self:
        """Return the table of rows with every column of any of them, in the order of their first use."""
        return cls(list(dict.fromkeys(column for row in rows for column in row)), rows)


def csv_text(columns: Sequence[str], rows: Iterable[dict[str, Cell]]) -> str:
    """Return the table as CSV (comma, line feed, header first); a column a row lacks stays empty."""
    buffer = io.StringIO(newline="")
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(csv_cell(column) for column in columns)
    for row in rows:
        writer.writerow(_cell(row.get(column)) for column in columns)
    return buffer.getvalue()


def _cell(value: Cell) -> str:
    if value is None or value != value:
        return ""
    if isinstance(value, str):
        return csv_cell(value)
    return str(value).lower() if isinstance(value, bool) else repr(value)
