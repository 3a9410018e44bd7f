"""The lines of samples in a text table, checked one by one before a library parses them."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TextIO

from uictest.core.recording.formats.layout import COMMENT, Dialect, TableLayout, cells_of
from uictest.core.recording.formats.problems import MOST_VALUES, UnreadableError

LONGEST_LINE = 2**20
"""characters"""


@dataclass(frozen=True, slots=True)
class SampleLines:
    """Which lines hold samples.

    Args:
        skipped: rising numbers of all other lines, from one: heading, comments, lines without a value.
        width: cells of the widest row of samples.

    """

    skipped: tuple[int, ...]
    width: int

    def number(self, row: int) -> int:
        """Return the number of the line that holds a row of samples, counted from zero."""
        number = row + 1
        while (later := row + 1 + bisect_right(self.skipped, number)) != number:
            number = later
        return number


def sample_lines(
    path: Path, encoding: str, dialect: Dialect, layout: TableLayout, channels: int
) -> SampleLines:
    """Return which lines of a file hold samples.

    Raises UnreadableError where a line has more values than there are channels, is too long, holds a NUL
    character or an open quotation, UnicodeError where it is not of the encoding.
    """
    skipped: list[int] = []
    width, rows = channels, 0
    blank = f'{dialect.delimiter} \t\r\n"'
    with path.open(encoding=encoding) as file:
        for number, line in _lines(file):
            if number < layout.first_line or line.startswith(COMMENT) or not line.strip(blank):
                skipped.append(number)
                continue
            cells, values = _counts(number, line, dialect.delimiter)
            if values > channels:
                raise UnreadableError(
                    f"line {number} has {values} cells; line {layout.header_line} names {channels} channels"
                )
            width, rows = max(width, cells), rows + 1
            if rows * width > MOST_VALUES:
                raise UnreadableError(f"more than {MOST_VALUES} values")
    if not rows:
        raise UnreadableError(f"no line of samples follows the names in line {layout.header_line}")
    return SampleLines(tuple(skipped), width)


def reject_open_quotation(number: int, line: str) -> None:
    """Raise UnreadableError for a line whose quotation marks are no pairs."""
    if line.count('"') % 2:
        raise UnreadableError(f"line {number} has a quotation mark that is not closed")


def _lines(file: TextIO) -> Iterator[tuple[int, str]]:
    for number, line in enumerate(iter(lambda: file.readline(LONGEST_LINE), ""), start=1):
        if len(line) >= LONGEST_LINE:
            raise UnreadableError(f"line {number} has more than {LONGEST_LINE} characters")
        if "\0" in line:
            raise UnreadableError(f"line {number} holds a NUL character: the file is damaged or no text")
        yield number, line


def _counts(number: int, line: str, delimiter: str) -> tuple[int, int]:
    """Return how many cells a line has, and how many up to its last value."""
    reject_open_quotation(number, line)
    if '"' in line:
        cells = cells_of(line, delimiter)
        return len(cells), max(k for k, cell in enumerate(cells, start=1) if cell)
    return line.count(delimiter) + 1, line.rstrip(f"{delimiter} \r\n").count(delimiter) + 1
