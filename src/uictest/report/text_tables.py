"""Tables as CSV and as Markdown, documents as Markdown: user text guarded, missing numbers as empty cells."""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from uictest.core.document import Cell, Column, Document, Lines, Table
from uictest.report.escaping import csv_cell, printable


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


_LONGEST = 300  # characters of one text in a cell
_BACKTICKS = re.compile("`+")
_ACTIVE = re.compile(r"[\\`*_{}\[\]<>#|~&@!$^]|:(?! |$)")
_RULES = {"l": "---", "r": "--:"}
_RESERVE = 200  # bytes kept for the line that says what was left out


@dataclass(frozen=True, slots=True)
class MarkdownTable:
    """A table whose cells are Markdown already.

    Args:
        columns: their headings.
        alignment: a letter for each column: `l` for texts, `r` for numbers.
        rows: see `row`.
        rest: what stands behind the number of rows that were left out, e.g. `more cases are in ...`.
        most: rows that a reader is to be given, None for all.

    """

    columns: Sequence[str]
    alignment: str
    rows: Sequence[str]
    rest: str = ""
    most: int | None = None

    def all(self) -> str:
        """Return every row."""
        return self._head + "".join(self.rows)

    @property
    def _head(self) -> str:
        return row(self.columns) + f"|{'|'.join(_RULES[letter] for letter in self.alignment)}|\n"

    def within(self, room: int) -> str:
        """Return the table in at most so many bytes; empty where there is no room for a single row.

        Where rows were left out, a last line says how many.
        """
        head = self._head
        shown = list(_fitting(self.rows[: self.most], room - len(head.encode()) - _RESERVE))
        if not shown and self.rows:
            return ""
        left_out = len(self.rows) - len(shown)
        return head + "".join(shown) + (f"\n{left_out} {self.rest}\n" if left_out else "")


def document_markdown(document: Document, limit: int | None = None, level: int = 1) -> str:
    """Return a document as a page whose title is a heading of this level; sections without content are none.

    With a limit it has at most so many bytes: rows and sections are left out, and lines say how many.
    """
    text = f"{'#' * level} {prose(document.title)}\n" + "".join(
        f"\n{prose(each)}\n" for each in document.about
    )
    left_out = 0
    for section in document.sections:
        heading = f"\n{'#' * (level + 1)} {prose(section.title)}\n" if section.title else ""
        room = None if limit is None else limit - len(f"{text}{heading}\n".encode()) - _RESERVE
        shown = _section(section, room)
        text += f"{heading}\n{shown}" if shown else ""
        left_out += not shown and bool(section.sentences if isinstance(section, Lines) else section.rows)
    return text + (f"\n{left_out} {document.more}\n" if left_out else "")


def _section(section: Table | Lines, room: int | None) -> str:
    """Return a section below its heading in at most so many bytes; empty where it has or fits nothing."""
    if isinstance(section, Lines):
        lines = [f"- {prose(each)}\n" for each in section.sentences]
        return "".join(lines) if room is None or sum(len(each.encode()) for each in lines) <= room else ""
    if not section.rows:
        return ""
    basis = f"{prose(section.basis)}\n\n" if section.basis else ""
    table = markdown_table(section)
    shown = table.all() if room is None else table.within(room - len(basis.encode()))
    return f"{basis}{shown}" if shown else ""


def markdown_table(table: Table, most: int | None = None, rest: str = "") -> MarkdownTable:
    """Return a table as Markdown; `most` and `rest` as there."""
    columns = [each for each, _ in table.texts]
    cells = [_markdown_cells(each, texts, table.rows) for each, texts in table.texts]
    headings = [prose(each.heading.replace("\n", ", ")) for each in columns]
    alignment = "".join("r" if each.right else "l" for each in columns)
    rows = list(map(row, zip(*cells, strict=True)))
    return MarkdownTable(headings, alignment, rows, rest or table.more, most)


def _markdown_cells(column: Column[Any], texts: Iterable[str], rows: Iterable[Any]) -> list[str]:
    cells = map(code if column.literal else prose, texts)
    if column.stands_out is None:
        return list(cells)
    return [
        f"**{cell}**" if column.stands_out(item) else cell for cell, item in zip(cells, rows, strict=True)
    ]


def row(cells: Iterable[str]) -> str:
    """Return a row of a table."""
    return f"| {' | '.join(cells)} |\n"


def _fitting(rows: Iterable[str], room: int) -> Iterator[str]:
    for each in rows:
        room -= len(each.encode())
        if room < 0:
            return
        yield each


def code(text: str) -> str:
    """Return a text as a code span that shows it letter by letter, also inside a table."""
    # In a code span nothing can be escaped, but a bar ends a cell: it is spelled out like what is invisible.
    shown = _cut(printable(text)).replace("|", "\\x7c")
    longest = max(map(len, _BACKTICKS.findall(shown)), default=0)
    fence = "`" * (longest + 1)
    padding = " " if shown.startswith("`") or shown.endswith("`") else ""
    return f"{fence}{padding}{shown}{padding}{fence}" if shown else ""


def prose(text: str) -> str:
    """Return a text with every character that Markdown or HTML could act upon as an entity."""
    return _ACTIVE.sub(lambda match: f"&#{ord(match.group())};", _cut(printable(text)))


def number_cell(value: float | None, form: str) -> str:
    """Return a number as a cell in a format, a dash where there is none."""
    return "–" if value is None or math.isnan(value) else format(value, form)  # noqa: RUF001 - a dash on paper


def _cut(text: str) -> str:
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 1]}…"
