"""Documents as text for a terminal: names are kept whole, columns that find no room are left out."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from typing import Final

from uictest.core.document import Block, Blocks, Document, Lines, Section, Table, Tone
from uictest.report.words import printable

GAP: Final = "  "
"""What stands between two columns."""
_PIECE: Final = re.compile(r"\[?(?:[^\[\s,/_=-]|=(?=[^,]{1,6}(?:,|$)))*[\s,/_=-]*")
"""A part of a name that is not broken: lines end before an opening bracket, after what joins words, and
between a key and a value of more than six characters."""
_COLOURS: Final[dict[Tone, str]] = {"good": "\x1b[32m", "bad": "\x1b[1;31m", "odd": "\x1b[1;35m"}
_END: Final = "\x1b[0m"


def coloured_text(text: str, tone: Tone | None) -> str:
    """Return a text in the colour of a tone."""
    return text if tone is None else f"{_COLOURS[tone]}{text}{_END}"


def document_lines(document: Document, width: int | None) -> Iterator[str]:
    """Yield the sections in so many characters, None for a stream that is not a terminal."""
    for section in document.sections:
        yield from section_lines(section, width)


def spaced_lines(document: Document, width: int | None) -> Iterator[str]:
    """Yield the sections, a blank line before and after each table."""
    beside_table = None
    for section in document.sections:
        lines = list(section_lines(section, width))
        is_table = isinstance(section, Table)
        if lines and beside_table is not None and (is_table or beside_table):
            yield ""
        yield from lines
        beside_table = is_table if lines else beside_table


def section_lines(section: Section, width: int | None, *, coloured: bool = False) -> Iterator[str]:
    """Yield a section without its title; sentences are wrapped, commands never."""
    if isinstance(section, Lines):
        for sentence in section.sentences:
            yield from wrapped_sentence(sentence, width)
    elif isinstance(section, Blocks):
        for block in section.blocks:
            yield from _block_lines(block, width, coloured=coloured)
    elif section.rows:
        yield from table_lines(section, width, coloured=coloured)


def _block_lines(block: Block, width: int | None, *, coloured: bool) -> Iterator[str]:
    """Yield a block: its heading, and indented its facts and its command."""
    for line in wrapped_sentence(block.heading, width):
        yield coloured_text(line, block.tone if coloured else None)
    for fact in block.lines:
        yield from wrapped_sentence(fact, width, indent="  ")
    if block.command:
        yield f"  {printable(block.command)}"


def wrapped_sentence(sentence: str, width: int | None, indent: str = "") -> list[str]:
    """Return a sentence in lines of at most so many characters, all but the first indented further."""
    text = f"{indent}{printable(sentence)}"
    if width is None or len(text) <= width:
        return [text]
    further = f"{indent}    "
    return textwrap.wrap(
        printable(sentence),
        width,
        initial_indent=indent,
        subsequent_indent=further,
        break_long_words=False,
        break_on_hyphens=False,
    )


def titled_lines(sections: Iterable[Section], width: int | None) -> Iterator[str]:
    """Yield sections under their titles, a blank line after each."""
    for section in sections:
        if isinstance(section, Lines) and section.sentences:
            yield from section_lines(section, width)
        elif isinstance(section, Table) and section.rows:
            yield from wrapped_sentence(": ".join(filter(None, (section.title, section.basis))), width)
            yield from (f"  {line}" for line in table_lines(section, None if width is None else width - 2))
        else:
            continue
        yield ""


def table_lines(table: Table, width: int | None, *, coloured: bool = False) -> Iterator[str]:
    """Yield the lines of a table; the last one names the columns left out and where they are."""
    columns = _text_columns(table, coloured=coloured)
    common = table.grouped_by
    hidden: dict[str, None] = {}
    if width is None or common is None or _total_width(columns) <= width:
        shown, left_out = _fitted_columns(columns, width)
        yield from _aligned_lines(shown)
        hidden.update(dict.fromkeys(left_out))
    else:
        others = [column for column in table.columns if column is not common]
        for text, rows in groupby(table.rows, key=common.cell_text):
            group = _text_columns(replace(table, columns=others, rows=list(rows)), coloured=coloured)
            shown, left_out = _fitted_columns(group, width)
            yield from wrapped_name(printable(text), width) if text else ()
            yield from _aligned_lines(shown)
            hidden.update(dict.fromkeys(left_out))
    if hidden:
        sentence = f"not shown for lack of room: {', '.join(hidden)}; {table.more} has all"
        yield from wrapped_sentence(sentence, width)


def aligned_rows(rows: Sequence[Sequence[str]]) -> Iterator[str]:
    """Yield the lines of rows of texts; every column has the same width in all rows."""
    return _aligned_lines([_TextColumn("", list(cells)) for cells in zip(*rows, strict=True)])


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


@dataclass(frozen=True, slots=True)
class _TextColumn:
    """A column with its texts, in several lines where there is a line feed; without a title it has none."""

    title: str
    texts: Sequence[str]
    rank: int = 0
    is_number: bool = False
    wraps: bool = False
    tones: Sequence[Tone | None] = ()
    name: str = ""

    @property
    def width(self) -> int:
        return max(len(line) for text in (self.title, *self.texts) for line in text.split("\n"))

    @property
    def longest_piece(self) -> int:
        """The least width in which no word of a text or the title is broken."""
        pieces = (piece for text in self.texts for piece in _PIECE.findall(text))
        return max(*(len(piece.rstrip()) for piece in pieces), *map(len, self.title.split("\n")))

    def cells(self) -> Iterator[list[str]]:
        """Yield the lines of every cell in the width of the column, the title first if there is one."""
        width, tones = self.width, self.tones or [None] * len(self.texts)
        align = str.rjust if self.is_number else str.ljust
        if self.title:
            yield [align(line, width) for line in self.title.split("\n")]
        for text, tone in zip(self.texts, tones, strict=True):
            yield [coloured_text(align(line, width), tone) for line in text.split("\n")]


def _text_columns(table: Table, *, coloured: bool) -> list[_TextColumn]:
    return [
        _TextColumn(
            _narrow_title(column.title, texts) if column.is_number else column.title,
            list(map(printable, texts)),
            column.rank,
            column.is_number,
            column.wraps,
            list(map(column.tone, table.rows)) if coloured and column.tone else (),
            column.heading.replace("-\n", "").partition("\n")[0],
        )
        for column, texts in table.for_people
    ]


_NARROWEST: Final = 9
"""Characters to which the title of a column of numbers may be wrapped; chosen: most words fit."""


def _narrow_title(title: str, texts: Sequence[str]) -> str:
    """Return the title of a column of numbers in lines that are no wider than its numbers need."""
    width = max([_NARROWEST, *map(len, texts)])
    return "\n".join(line for part in title.split("\n") for line in wrapped_name(part, width))


def _total_width(columns: Sequence[_TextColumn]) -> int:
    return sum(column.width for column in columns) + len(GAP) * (len(columns) - 1)


def _aligned_lines(columns: Sequence[_TextColumn]) -> Iterator[str]:
    """Yield the lines of columns side by side; shorter cells end in blank lines."""
    blanks = [" " * column.width for column in columns]
    for row in zip(*(column.cells() for column in columns), strict=True):
        for line in range(max(map(len, row))):
            parts = [
                cell[line] if line < len(cell) else blank for cell, blank in zip(row, blanks, strict=True)
            ]
            yield GAP.join(parts).rstrip()


def _fitted_columns(columns: Sequence[_TextColumn], width: int | None) -> tuple[list[_TextColumn], list[str]]:
    """Return the columns as they fit into so many characters, and the names of those left out.

    Columns are left out until every text that wraps has its whole length, or half of the width shared with
    the others; then the last columns of numbers until no word is broken. Texts that are still longer are
    wrapped.
    """
    if width is None:
        return list(columns), []
    remaining, left_out = list(columns), set[str]()
    for column in sorted(columns, key=lambda column: -column.rank):
        if column.rank == 0 or _least_width(remaining, width // 2) <= width:
            break
        remaining.remove(column)
        left_out.add(column.name)
    for column in [column for column in reversed(remaining) if column.is_number]:
        if _least_width(remaining, 0) <= width:
            break
        remaining.remove(column)
        left_out.add(column.name)
    return _wrapped_columns(remaining, width), [column.name for column in columns if column.name in left_out]


def _least_width(columns: Sequence[_TextColumn], room: int) -> int:
    """Return the width that columns need if texts that wrap take at least their share of so much room."""
    share = room // max(sum(column.wraps for column in columns), 1)
    widths = [
        min(column.width, max(share, column.longest_piece)) if column.wraps else column.width
        for column in columns
    ]
    return sum(widths) + len(GAP) * (len(columns) - 1)


def _wrapped_columns(columns: Sequence[_TextColumn], width: int) -> list[_TextColumn]:
    """Return the columns with texts wrapped where there is no room for all of them."""
    fixed = sum(column.width for column in columns if not column.wraps) + len(GAP) * (len(columns) - 1)
    wrapping = sorted((column for column in columns if column.wraps), key=lambda column: column.width)
    room, texts = max(width - fixed, len(wrapping)), dict[str, list[str]]()
    for number, column in enumerate(wrapping):
        own_width = max(min(column.width, room // (len(wrapping) - number)), 1)
        room -= own_width
        texts[column.title] = ["\n".join(wrapped_name(text, own_width)) for text in column.texts]
    return [replace(column, texts=texts[column.title]) if column.wraps else column for column in columns]
