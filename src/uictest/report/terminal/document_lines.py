"""A document as the lines of a terminal."""

from __future__ import annotations

from collections.abc import Iterator

from uictest.core.document import Document, Lines, Table
from uictest.report.escaping import printable
from uictest.report.terminal.fitted_columns import TableColumn, aligned, columns_not_shown, fitted


def document_lines(document: Document, width: int | None) -> Iterator[str]:
    """Yield the sections in so many characters, None for a stream that is no terminal."""
    for section in document.sections:
        if isinstance(section, Lines):
            yield from map(printable, section.sentences)
        elif section.rows:
            yield from table_lines(section, width)


def table_lines(table: Table, width: int | None) -> Iterator[str]:
    """Yield the lines of a table; the last one names the columns left out and where they are."""
    shown, hidden = fitted(table_columns(table), width)
    yield from aligned(shown)
    if line := columns_not_shown(hidden, table.more):
        yield line


def table_columns(table: Table) -> list[TableColumn]:
    """Return the columns for people with their texts."""
    return [
        TableColumn(
            each.heading,
            [printable(each.text(row)) for row in table.rows],
            *(each.rank, each.right, each.wraps),
        )
        for each in table.columns
    ]
