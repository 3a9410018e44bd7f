"""A table that keeps to the width of a terminal: names are kept whole, measures are left out."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby
from typing import NamedTuple

from uictest.core.document import Document, Lines, Table
from uictest.report.escaping import printable

GAP = "  "
"""What stands between two columns."""

_PIECE = re.compile(r"\[?[^\[\s,/_=-]*[\s,/_=-]*")
"""A part of a name that is not broken: lines end before an opening bracket and behind what joins words."""


class TableColumn(NamedTuple):
    """A column of a table.

    Args:
        title: what it is called; a line feed begins the second line of its heading.
        cells: its texts, one for each row; shown as they are, so printable.
        rank: the column with the highest rank is left out first; one of rank 0 never is.
        right: whether it holds numbers, which are aligned to the right.
        wraps: whether its texts may continue on the next line.

    """

    title: str
    cells: Sequence[str]
    rank: int = 0
    right: bool = False
    wraps: bool = False

    @property
    def width(self) -> int:
        """How wide the longest text is."""
        return max(map(len, (*self.title.split("\n"), *self.cells)))


def fitted(columns: Sequence[TableColumn], width: int | None) -> tuple[list[TableColumn], list[TableColumn]]:
    """Return the columns as they fit into so many characters, and those left out.

    Columns are left out until every text that wraps has its whole length, or half of the width shared with
    the others. Texts that are still longer are wrapped.
    """
    if width is None:
        return list(columns), []
    shown, hidden = list(columns), []
    for column in sorted(columns, key=lambda each: -each.rank):
        if column.rank == 0 or _least_width(shown, width) <= width:
            break
        shown.remove(column)
        hidden.append(column)
    return _wrapped(shown, width), [column for column in columns if column in hidden]


def table_width(columns: Sequence[TableColumn]) -> int:
    """Return how wide the lines of a table are."""
    return sum(column.width for column in columns) + len(GAP) * (len(columns) - 1)


def aligned(columns: Sequence[TableColumn]) -> Iterator[str]:
    """Yield the lines of a table, the titles first."""
    return aligned_rows(list(zip(*((column.title, *column.cells) for column in columns), strict=True)))


def aligned_rows(rows: Sequence[Sequence[str]]) -> Iterator[str]:
    """Yield the lines of rows of cells; every column has the same width in all rows."""
    texts = [[cell.split("\n") for cell in row] for row in rows]
    widths = [max(len(line) for cell in cells for line in cell) for cells in zip(*texts, strict=True)]
    for row in texts:
        for line in range(max(map(len, row))):
            parts = [cell[line] if line < len(cell) else "" for cell in row]
            yield GAP.join(map(str.ljust, parts, widths)).rstrip()


def wrapped_name(name: str, width: int) -> list[str]:
    """Return a name in lines of at most so many characters; a word is broken only where it is longer."""
    lines = [""]
    for piece in filter(None, _PIECE.findall(name)):
        if lines[-1] and len(f"{lines[-1]}{piece}".rstrip()) > width:
            lines.append("")
        lines[-1] += piece
        while len(lines[-1].rstrip()) > width:
            lines[-1:] = [lines[-1][:width], lines[-1][width:]]
    return [line.rstrip() for line in lines]


def columns_not_shown(hidden: Sequence[TableColumn], place: str) -> str:
    """Return the line that names the columns left out, and where to find them; empty if there is none."""
    names = ", ".join(title for column in hidden if (title := column.title.partition("\n")[0]))
    return f"not shown for lack of room: {names}; {place}" if names else ""


def _least_width(columns: Sequence[TableColumn], width: int) -> int:
    """Return how much room columns need at least, if texts that wrap may take their share of the width."""
    share = _share(columns, width)
    widths = [min(column.width, _room(column, share)) if column.wraps else column.width for column in columns]
    return sum(widths) + len(GAP) * (len(columns) - 1)


def _share(columns: Sequence[TableColumn], width: int) -> int:
    return width // 2 // max(sum(column.wraps for column in columns), 1)


def _room(column: TableColumn, share: int) -> int:
    """Return the width a column should have: its share, more where one of its words is longer."""
    longest = max(len(piece.rstrip()) for cell in column.cells for piece in _PIECE.findall(cell))
    return max(share, longest, max(map(len, column.title.split("\n"))))


def _wrapped(columns: Sequence[TableColumn], width: int) -> list[TableColumn]:
    """Return the columns with texts wrapped where there is no room for all of them."""
    fixed = sum(column.width for column in columns if not column.wraps) + len(GAP) * (len(columns) - 1)
    names = sorted((column for column in columns if column.wraps), key=lambda each: each.width)
    room, texts = max(width - fixed, len(names)), {}
    for place, column in enumerate(names):
        own = max(min(column.width, room // (len(names) - place)), 1)
        room -= own
        texts[column.title] = ["\n".join(wrapped_name(cell, own)) for cell in column.cells]
    return [
        TableColumn(each.title, texts[each.title], each.rank, each.right, wraps=True) if each.wraps else each
        for each in columns
    ]


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
        shown, hidden = fitted(table_columns(table._replace(columns=others, rows=list(rows))), width)
        yield [*(wrapped_name(printable(text), width) if text else ()), *aligned(shown)], hidden


def table_columns(table: Table) -> list[TableColumn]:
    """Return the columns of a table with their texts."""
    return [
        TableColumn(each.heading, list(map(printable, texts)), each.rank, each.right, each.wraps)
        for each, texts in table.texts
    ]
