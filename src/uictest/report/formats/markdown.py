"""Documents as Markdown: user text guarded, in at most so many bytes."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from typing import Any, Final

from uictest.core.document import Block, Column, Document, Lines, Section, Table
from uictest.report.words import printable

_LONGEST: Final = 300
"""Characters of one text in a cell."""
_RESERVE: Final = 200
"""Bytes kept for the line that says what was left out."""
_BACKTICKS: Final = re.compile("`+")
_ACTIVE: Final = re.compile(r"[\\`*_{}\[\]<>#|~&@!$^]|:(?! |$)")
_BEGINS_BLOCK: Final = re.compile(r"^(?:[-+](?=[-\s]*$|\s)|\d(?=\d*[.)](?:\s|$)))")


def document_markdown(document: Document, limit: int | None = None, level: int = 1) -> str:
    """Return a document as a page whose title is a heading of this level; sections without content are none.

    With a limit it has at most so many bytes: rows and sections are left out, and lines say how many.
    """
    text = f"{'#' * level} {prose(document.title)}\n" + "".join(
        f"\n{prose(line)}\n" for line in document.about
    )
    left_out = 0
    for section in document.sections:
        heading = f"\n{'#' * (level + 1)} {prose(section.title)}\n" if section.title else ""
        room = None if limit is None else limit - len(f"{text}{heading}\n".encode()) - _RESERVE
        body = _section(section, room)
        text += f"{heading}\n{body}" if body else ""
        left_out += not body and bool(_section(section, None))
    return text + (f"\n{left_out} more in `{document.all_in}`.\n" if left_out else "")


def _section(section: Section, room: int | None) -> str:
    """Return a section without its title; empty where it has no content, or no room."""
    if isinstance(section, Table):
        return _table(section, room)
    if isinstance(section, Lines):
        text = "".join(f"- {prose(sentence)}\n" for sentence in section.sentences)
    else:
        text = "\n".join(map(_block, section.blocks))
    return text if room is None or len(text.encode()) <= room else ""


def _block(block: Block) -> str:
    facts = "".join(f"- {prose(line)}\n" for line in block.lines)
    command = f"\n{code(block.command, longest=None)}\n" if block.command else ""
    return f"**{prose(block.heading)}**\n\n{facts}{command}"


def _table(table: Table, room: int | None) -> str:
    if not table.rows:
        return ""
    basis = f"{prose(table.basis)}\n\n" if table.basis else ""
    body = markdown_table(table, None if room is None else room - len(basis.encode()))
    return f"{basis}{body}" if body else ""


def markdown_table(table: Table, room: int | None = None) -> str:
    """Return a table in at most so many bytes; empty where there is no room for a single row.

    Where rows were left out, a last line says how many.
    """
    columns = table.for_people
    if not columns:
        return ""
    titles = (_inert_text(column.title.replace("\n", ", ")) for column, _ in columns)
    rules = "|".join("--:" if column.is_number else "---" for column, _ in columns)
    text = f"{_row(titles)}|{rules}|\n"
    cells = [_cells(column, texts, list(table.rows)) for column, texts in columns]
    rows = [_row(row) for row in zip(*cells, strict=True)]
    written = 0
    for row in rows[: table.most]:
        if room is not None and len((text + row).encode()) > room - _RESERVE:
            break
        text += row
        written += 1
    if rows and not written:
        return ""
    left_out = len(rows) - written
    return text + (f"\n{left_out} more in `{table.more}`.\n" if left_out else "")


def _cells(column: Column[Any], texts: Sequence[str], rows: Sequence[Any]) -> list[str]:
    cells = [code(text) if column.literal else _inert_text(text) for text in texts]
    if column.tone is None:
        return cells
    tones = map(column.tone, rows)
    return [
        f"**{cell}**" if tone in ("bad", "odd") else cell for cell, tone in zip(cells, tones, strict=True)
    ]


def _row(cells: Iterable[str]) -> str:
    return f"| {' | '.join(cells)} |\n"


def code(text: str, longest: int | None = _LONGEST) -> str:
    """Return a text as a code span that shows it letter by letter, also inside a table."""
    # In a code span nothing can be escaped, but a bar ends a cell: it is spelled out like what is invisible.
    shown = _cut_text(printable(text), longest).replace("|", "\\x7c")
    fence = "`" * (max(map(len, _BACKTICKS.findall(shown)), default=0) + 1)
    padding = " " if shown.startswith("`") or shown.endswith("`") else ""
    return f"{fence}{padding}{shown}{padding}{fence}" if shown else ""


def prose(text: str) -> str:
    """Return a text with every character that Markdown or HTML could act upon as an entity."""
    return _BEGINS_BLOCK.sub(_entity, _inert_text(text))


def _inert_text(text: str) -> str:
    """Return a text as a cell or after other text, where it begins no block."""
    return _ACTIVE.sub(_entity, _cut_text(printable(text)).strip())


def _entity(match: re.Match[str]) -> str:
    return f"&#{ord(match.group())};"


def _cut_text(text: str, longest: int | None = _LONGEST) -> str:
    return text if longest is None or len(text) <= longest else f"{text[: longest - 1]}…"
