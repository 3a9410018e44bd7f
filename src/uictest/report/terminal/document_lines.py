"""A document as the lines of a terminal."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Iterator
from itertools import groupby

from uictest.core.document import Document, Lines, Table
from uictest.report.escaping import printable
from uictest.report.terminal.fitted_columns import (
    TableColumn,
    aligned,
    columns_not_shown,
    fitted,
    table_width,
    wrapped_name,
)


def document_lines(document: Document, width: int | None) -> Iterator[str]:
    """Yield the sections in so many characters, None for a stream that is no terminal."""
    for section in document.sections:
        if isinstance(section, Lines):
            yield from map(printable, section.sentences)
        elif section.rows:
            yield from table_lines(section, width)


def titled_lines(sections: Iterable[Table | Lines], width: int | None) -> Iterator[str]:
    """Yield sections under their titles, a blank line behind each."""
    for section in sections:
        if isinstance(section, Lines):
            yield from map(printable, section.sentences)
        elif section.rows:
            yield printable(": ".join(filter(None, (section.title, section.basis))))
            yield from (f"  {line}" for line in table_lines(section, None if width is None else width - 2))
        else:
            continue
        yield ""


def table_lines(table: Table, width: int | None) -> Iterator[str]:
    """Yield the lines of a table; the last one names the columns left out and where they are."""
    columns = table_columns(table)
    if width is None or table.grouped_by is None or table_width(columns) <= width:
        shown, hidden = fitted(columns, width)
        yield from aligned(shown)
    else:
        hidden = []
        for lines, left_out in _groups(table, width):
            yield from lines
            hidden += [each for each in left_out if each.title not in {known.title for known in hidden}]
    if line := columns_not_shown(hidden, table.more):
        yield line


def _groups(table: Table, width: int) -> Iterator[tuple[list[str], list[TableColumn]]]:
    """Yield the lines of each run of rows that share a text, and the columns left out there."""
    common = table.grouped_by
    assert common is not None
    others = [each for each in table.columns if each is not common]
    for text, rows in groupby(table.rows, key=common.text):
        shown, hidden = fitted(
            table_columns(dataclasses.replace(table, columns=others, rows=list(rows))), width
        )
        yield [*(wrapped_name(printable(text), width) if text else ()), *aligned(shown)], hidden


def table_columns(table: Table) -> list[TableColumn]:
    """Return the columns of a table with their texts."""
    return [
        TableColumn(each.heading, list(map(printable, texts)), each.rank, each.right, each.wraps)
        for each, texts in table.texts
    ]
