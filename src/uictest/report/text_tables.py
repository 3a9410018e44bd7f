"""Tables as CSV and as Markdown, documents as Markdown: user text guarded, missing numbers as empty cells."""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Iterable, Iterator, Sequence
from html import escape
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
_BEGINS_BLOCK = re.compile(r"^(?:[-+](?=[-\s]*$|\s)|\d(?=\d*[.)](?:\s|$)))")
_RESERVE = 200  # bytes kept for the line that says what was left out


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
    shown = markdown_table(section, None if room is None else room - len(basis.encode()))
    return f"{basis}{shown}" if shown else ""


def markdown_table(table: Table, room: int | None = None) -> str:
    """Return a table in at most so many bytes; empty where there is no room for a single row.

    Where rows were left out, a last line says how many.
    """
    columns = [each for each, _ in table.texts]
    cells = [_markdown_cells(each, texts, table.rows) for each, texts in table.texts]
    rules = "|".join("--:" if each.right else "---" for each in columns)
    head = f"{row(prose(each.heading.replace(chr(10), ', ')) for each in columns)}|{rules}|\n"
    rows = list(map(row, zip(*cells, strict=True)))
    fitting = rows[: table.most]
    if room is not None:
        fitting = list(_fitting(fitting, room - len(head.encode()) - _RESERVE))
    if rows and not fitting:
        return ""
    left_out = len(rows) - len(fitting)
    return head + "".join(fitting) + (f"\n{left_out} {table.more}\n" if left_out else "")


def _markdown_cells(column: Column[Any], texts: Iterable[str], rows: Iterable[Any]) -> list[str]:
    cells = map(code if column.literal else prose, texts)
    if column.tone is None:
        return list(cells)
    tones = map(column.tone, rows)
    return [
        f"**{cell}**" if tone in ("bad", "odd") else cell for cell, tone in zip(cells, tones, strict=True)
    ]


_COLOURS = {"good": "#1a7f37", "bad": "#cf222e", "odd": "#8250df"}


def html_table(table: Table) -> str:
    """Return a table as HTML that needs no style sheet, for a notebook; texts are escaped."""
    heads = "".join(f"<th>{escape(each.heading.replace(chr(10), ', '))}</th>" for each, _ in table.texts)
    body = "".join(
        f"<tr>{''.join(_html_cell(each, item) for each, _ in table.texts)}</tr>" for item in table.rows
    )
    return f"<table><thead><tr>{heads}</tr></thead><tbody>{body}</tbody></table>"


def _html_cell(column: Column[Any], item: object) -> str:
    tone = column.tone(item) if column.tone else None
    style = f' style="color:{_COLOURS[tone]}"' if tone else ""
    return f"<td{style}>{escape(printable(column.text(item)))}</td>"


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
    inert = _ACTIVE.sub(_entity, _cut(printable(text)).strip())
    return _BEGINS_BLOCK.sub(_entity, inert)


def _entity(match: re.Match[str]) -> str:
    return f"&#{ord(match.group())};"


def number_cell(value: float | None, form: str) -> str:
    """Return a number as a cell in a format, a dash where there is none."""
    return "–" if value is None or math.isnan(value) else format(value, form)  # noqa: RUF001 - a dash on paper


def _cut(text: str) -> str:
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 1]}…"
