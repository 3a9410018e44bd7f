"""Recordings as text tables of a declared dialect."""

from __future__ import annotations

import csv
import io
import itertools
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TextIO

from uictest.core.recording.formats.cells import LONGEST_TEXT, Cells, TextColumn, joined
from uictest.core.recording.formats.file_formats import MOST_CHANNELS, MOST_VALUES, UnreadableError
from uictest.core.recording.formats.layout import (
    BYTE_ORDER_MARK,
    COMMENT,
    END_OF_HEADER,
    Dialect,
    TableLayout,
    cells_of,
    encoding_of,
    names_and_units_of,
    table_layout,
    undecodable,
)
from uictest.core.recording.recording import TIME, Contents, Group, Recording

LONGEST_LINE = 2**20
"""characters"""
_HEADING = 1000
"""Most lines before the first sample."""
_ROWS = 2**12
"""Rows of which the cells are read at once; chosen."""
_DIGITS = 10
_DIGITS_OF_TIME = 16
"""All but those of rounding: a time that is off by more is that of another state."""
REMARK = "Comment"
"""Last channel of LabVIEW's text files, whose cells are left out where they are empty."""
INTERVAL = "Delta_X"
"""Where LabVIEW's text files state their sampling interval, s."""


@dataclass(frozen=True, slots=True)
class TextTable:
    """A text whose table is known.

    Args:
        path: of the file.
        dialect: by which it is read.
        encoding: that of the file.
        heading: its first lines.
        layout: where names, units and samples stand.
        names: of the channels, all different.
        units: of each channel; empty where none is stated.

    """

    path: Path
    dialect: Dialect
    encoding: str
    heading: Sequence[str]
    layout: TableLayout
    names: list[str]
    units: list[str]

    @property
    def cells(self) -> Cells:
        """What reads its cells."""
        return self.dialect.cells

    def line_of(self, name: str, text: str) -> str:
        """Return where a text first stands in a channel, for a reader."""
        k = self.names.index(name)
        found = (
            number for number, row in self.rows() if "".join(row[k : k + 1]).strip()[:LONGEST_TEXT] == text
        )
        return f"line {next(found)}, column {k + 1}"

    def require_complete(self, numbers: Sequence[str]) -> None:
        """Raise UnreadableError with the first line that is too short, or has no number in such a channel."""
        columns, cells = [self.names.index(name) for name in numbers], self.cells
        least = len(self.names) - (self.names[-1] == REMARK)
        for number, row in self.rows():
            if len(row) < least:
                raise UnreadableError(f"line {number} has {len(row)} cells; {self._heading}")
            for k in columns:
                if cells.is_text(row[k]):
                    raise UnreadableError(cells.refusal(row[k], f"line {number}, column {k + 1}"))

    @property
    def _heading(self) -> str:
        return f"line {self.layout.header_line} names {len(self.names)} channels"

    def rows(self) -> Iterator[tuple[int, list[str]]]:
        """Yield numbers and cells of the lines of samples: those with a value that are no comments.

        Raises UnreadableError where a line has more values than there are channels, is too long, holds a NUL
        character or an open quotation, UnicodeError where it is not of the encoding.
        """
        channels, last_line = len(self.names), self.layout.first_line - 1
        with self.path.open(encoding=self.encoding) as file:
            reader = csv.reader(self._lines(file), delimiter=self.dialect.delimiter)
            for row in reader:
                number = last_line + reader.line_num
                if len(row) > channels and any(cell.strip() for cell in row[channels:]):
                    raise UnreadableError(
                        f"line {number} has {len(row)} cells, {self._heading}:"
                        " name every column, and write numbers with decimal commas in quotation marks"
                    )
                if row:
                    yield number, row

    def _lines(self, file: TextIO) -> Iterator[str]:
        """Yield the lines below the heading, blank where they have no samples."""
        blank = f'{self.dialect.delimiter} \t\r\n"'
        for number, line in enumerate(iter(partial(file.readline, LONGEST_LINE), ""), start=1):
            if len(line) >= LONGEST_LINE:
                raise UnreadableError(f"line {number} has more than {LONGEST_LINE} characters")
            if "\0" in line:
                raise UnreadableError(
                    f"line {number} holds a NUL character: the file is damaged there, or no text"
                )
            if number < self.layout.first_line:
                continue
            if line.startswith(COMMENT) or not line.strip(blank):
                yield "\n"
                continue
            if line.startswith(END_OF_HEADER):
                raise UnreadableError(
                    f"line {number} ends the header of another segment: write each into a file of its own"
                )
            reject_open_quotation(number, line)
            yield line

    def require_names(self, widest: int) -> None:
        """Raise UnreadableError where no row is as wide as the heading: its names are shifted."""
        numbered = enumerate(self.names, start=1)
        named = max((k for k, name in numbered if name not in (f"column {k}", REMARK)), default=1)
        if not widest:
            raise UnreadableError(f"no line of samples follows the names in line {self.layout.header_line}")
        if widest < named:
            raise UnreadableError(
                f"{self._heading}, but no line of samples has more than {widest} cells: correct it, so that"
                " each name stands above its column"
            )


def add_texts(group: Group, name: str, column: TextColumn, places: dict[str, str]) -> None:
    """Add a column to a group; `places` are those of its first texts."""
    group.channels[name] = column.samples
    if column.texts is not None:
        group.numbers[name] = column.numbers
    if places:
        group.first_texts[name] = places


def opened(path: Path, dialect: Dialect) -> TextTable:
    """Return the table of a text. Raises UnreadableError where it is none of this dialect, UnicodeError."""
    encoding = encoding_of(path, dialect.encoding)
    heading = heading_of(path, encoding, dialect)
    layout = table_layout(heading, dialect)
    return TextTable(path, dialect, encoding, heading, layout, *names_and_units(heading, layout, dialect))


def reject_open_quotation(number: int, line: str) -> None:
    """Raise UnreadableError for a line whose quotation marks are no pairs."""
    if '"' in line and line.count('"') % 2:
        raise UnreadableError(f"line {number} has a quotation mark that is not closed")


def read(path: Path, dialect: Dialect | None = None) -> Contents:
    """Read a table; lines that begin with `#` are comments, `# key: value` among them facts.

    A cell that is no number makes its channel one of texts: a channel map says what they mean.

    Raises UnreadableError where the file is no table of this dialect.
    """
    dialect = dialect or Dialect()
    try:
        table = opened(path, dialect)
        group = _group(table)
    except UnicodeError as error:
        raise UnreadableError(undecodable(path, encoding_of(path, dialect.encoding))) from error
    except csv.Error as error:
        raise UnreadableError(f"not a table: {error}") from error
    return Contents((group,), {**_facts(table.heading), **_interval(table)}, dialect=dialect)


def encoded(recording: Recording) -> bytes:
    """Return a recording with its facts as comments above it."""
    text = io.StringIO(newline="")
    for key, value in recording.metadata.items():
        text.write(f"{COMMENT} {_one_line(key)}: {_one_line(value)}\n")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(f"{name} [{recording.units[name]}]" for name in recording.channels)
    digits = {name: _DIGITS_OF_TIME if name == TIME else _DIGITS for name in recording.channels}
    columns = [[f"{value:.{digits[name]}g}" for value in recording[name]] for name in digits]
    writer.writerows(zip(*columns, strict=True))
    return text.getvalue().encode()


def _one_line(text: str) -> str:
    return " ".join(text.split())


def heading_of(path: Path, encoding: str, dialect: Dialect) -> list[str]:
    """Return the first lines; enough of them to hold every declared one."""
    count = max(dialect.header_line, dialect.unit_line, dialect.first_line) + _HEADING
    with path.open(encoding=encoding) as file:
        lines = list(itertools.islice(iter(lambda: file.readline(LONGEST_LINE), ""), count))
    if any(len(line) >= LONGEST_LINE for line in lines):
        raise UnreadableError(f"a line of more than {LONGEST_LINE} characters")
    return [lines[0].removeprefix(BYTE_ORDER_MARK), *lines[1:]] if lines else []


def names_and_units(
    heading: Sequence[str], layout: TableLayout, dialect: Dialect
) -> tuple[list[str], list[str]]:
    """Return names, made distinct, and their units: those in the names, else those of the line of units."""
    named = names_and_units_of(_cells(heading, layout.header_line, dialect))
    below = _cells(heading, layout.unit_line, dialect) if layout.unit_line else []
    if not 0 < len(named) <= MOST_CHANNELS:
        raise UnreadableError(f"{len(named)} columns; expected 1 to {MOST_CHANNELS}")
    below += [""] * len(named)
    units = [unit or below[k].strip("[]() ") for k, (_, unit) in enumerate(named)]
    return _distinct([name for name, _ in named]), units


def _cells(heading: Sequence[str], number: int, dialect: Dialect) -> list[str]:
    if number > len(heading):
        raise UnreadableError(f"the file has no line {number}")
    reject_open_quotation(number, heading[number - 1])
    return cells_of(heading[number - 1], dialect.delimiter)


def _distinct(names: Sequence[str]) -> list[str]:
    """Return names with a number behind each that is there more than once: none of them is *the* channel."""
    filled = [name or f"column {position}" for position, name in enumerate(names, start=1)]
    counts = Counter(filled)
    numbers: Counter[str] = Counter()
    distinct = []
    for name in filled:
        numbers[name] += 1
        distinct.append(name if counts[name] == 1 else f"{name} ({numbers[name]})")
    return distinct


def _group(table: TextTable) -> Group:
    """Return the samples of a table, read in blocks of rows."""
    lines: list[int] = []
    blocks: list[list[TextColumn]] = []
    widest, rows = 0, table.rows()
    while block := list(itertools.islice(rows, _ROWS)):
        lines += (number for number, _ in block)
        widest = max(widest, *(len(row) for _, row in block))
        if len(lines) * len(table.names) > MOST_VALUES:
            raise UnreadableError(f"more than {MOST_VALUES} values")
        columns = itertools.zip_longest(*(row for _, row in block))
        padded = itertools.chain(columns, itertools.repeat((None,) * len(block)))
        blocks.append([table.cells.column(next(padded)) for _ in table.names])
    table.require_names(widest)
    units = {name: unit for name, unit in zip(table.names, table.units, strict=True) if unit}
    group = Group("", {}, units)
    for k, name in enumerate(table.names):
        column = joined([block[k] for block in blocks])
        places = {text: f"line {lines[row]}, column {k + 1}" for text, row in column.first_rows().items()}
        add_texts(group, name, column, places)
    return group


def _interval(table: TextTable) -> dict[str, str]:
    """Return the sampling interval that LabVIEW states above a table, as a fact."""
    for line in table.heading[: table.layout.header_line]:
        name, number = [*cells_of(line, table.dialect.delimiter), "", ""][:2]
        if name == INTERVAL and not table.cells.is_text(number):
            return {INTERVAL: f"{table.cells.column([number]).numbers[0]:.12g}"}
    return {}


def _facts(heading: Sequence[str]) -> dict[str, str]:
    return dict(_fact_lines(heading))


def _fact_lines(heading: Sequence[str]) -> Iterator[tuple[str, str]]:
    for line in heading:
        key, colon, value = line.removeprefix(COMMENT).partition(":")
        if line.startswith(COMMENT) and colon and key.strip():
            yield key.strip(), value.strip()
