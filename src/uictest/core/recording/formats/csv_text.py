"""Recordings as text tables of a declared dialect."""

from __future__ import annotations

import csv
import io
import itertools
from collections import Counter
from collections.abc import Iterator, Sequence, Set
from dataclasses import dataclass, replace
from functools import partial
from itertools import zip_longest
from pathlib import Path
from typing import Final, TextIO

import numpy as np

from uictest.core.recording.formats.cells import LONGEST_TEXT, Cells, TextColumn, grouping_of, joined
from uictest.core.recording.formats.file_formats import MOST_CHANNELS, MOST_VALUES, UnreadableError, facts_in
from uictest.core.recording.formats.layout import (
    BYTE_ORDER_MARK,
    COMMENT,
    END_OF_HEADER,
    OF_WINDOWS,
    Dialect,
    TableLayout,
    cells_of,
    encoding_of,
    likely_layout,
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
        """The reader of its cells."""
        return self.dialect.cells

    def location_of(self, name: str, text: str) -> str:
        """Return the location of the first occurrence of a text in a channel, for messages."""
        k = self.names.index(name)
        cells = ((number, "".join(row[k : k + 1])) for number, row in self.rows())
        line = next(number for number, cell in cells if cell.strip()[:LONGEST_TEXT] == text)
        return f"line {line}, column {k + 1}"

    def require_complete(self, numbers: Sequence[str]) -> None:
        """Raise UnreadableError with the first line that is too short, or has no number in such a channel."""
        columns, cells = [self.names.index(name) for name in numbers], self.cells
        least = len(self.names) - (self.names[-1] == REMARK)
        for number, row in self.rows():
            if len(row) < least:
                raise UnreadableError(f"line {number} has {len(row)} cells; {self._width_text}")
            for k in columns:
                if cells.is_text(row[k]):
                    raise UnreadableError(cells.refusal(row[k], f"line {number}, column {k + 1}"))

    @property
    def _width_text(self) -> str:
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
                        f"line {number} has {len(row)} cells, {self._width_text}:"
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
                f"{self._width_text}, but no line of samples has more than {widest} cells: correct it, so"
                " that each name stands above its column"
            )


def add_texts(group: Group, name: str, column: TextColumn, locations: dict[str, str]) -> None:
    """Add a column to a group; `locations` are those of its first texts."""
    group.channels[name] = column.samples
    if column.texts is not None:
        group.numbers[name] = column.numbers
    if locations:
        group.first_texts[name] = locations


def opened(path: Path, dialect: Dialect) -> TextTable:
    """Return the table of a text. Raises UnreadableError where it is none of this dialect, UnicodeError."""
    encoding = encoding_of(path, dialect.encoding)
    heading = heading_of(path, encoding, dialect)
    layout = table_layout(heading, dialect)
    return TextTable(path, dialect, encoding, heading, layout, *names_and_units(heading, layout, dialect))


def reject_open_quotation(number: int, line: str) -> None:
    """Raise UnreadableError for a line with an unpaired quotation mark."""
    if '"' in line and line.count('"') % 2:
        raise UnreadableError(f"line {number} has a quotation mark that is not closed")


def read(path: Path, dialect: Dialect | None = None) -> Contents:
    """Read a table; lines that begin with `#` are comments, `# key: value` among them facts.

    A cell that is not a number makes its channel one of texts, whose meaning a channel map states.

    Raises UnreadableError where the file is not a table of this dialect.
    """
    dialect = dialect or Dialect()
    if dialect.by_itself:
        return _read_by_detected_dialect(path, dialect)
    try:
        table = opened(path, dialect)
        group = _group_of_table(table)
    except UnicodeError as error:
        raise UnreadableError(undecodable(path, encoding_of(path, dialect.encoding))) from error
    except csv.Error as error:
        raise UnreadableError(f"not a table: {error}") from error
    facts = facts_in(line.removeprefix(COMMENT) for line in table.heading if line.startswith(COMMENT))
    return Contents((group,), {**facts, **_stated_interval(table)}, dialect=dialect)


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
    named = names_and_units_of(_cells_of_heading_line(heading, layout.header_line, dialect))
    below = _cells_of_heading_line(heading, layout.unit_line, dialect) if layout.unit_line else []
    if not 0 < len(named) <= MOST_CHANNELS:
        raise UnreadableError(f"{len(named)} columns; expected 1 to {MOST_CHANNELS}")
    below += [""] * len(named)
    units = [unit or below[k].strip("[]() ") for k, (_, unit) in enumerate(named)]
    return _numbered_duplicates([name for name, _ in named]), units


def _cells_of_heading_line(heading: Sequence[str], number: int, dialect: Dialect) -> list[str]:
    if number > len(heading):
        raise UnreadableError(f"the file has no line {number}")
    reject_open_quotation(number, heading[number - 1])
    return cells_of(heading[number - 1], dialect.delimiter)


def _numbered_duplicates(names: Sequence[str]) -> list[str]:
    """Return names, with a number after each that occurs more than once: none of them is *the* channel."""
    filled = [name or f"column {position}" for position, name in enumerate(names, start=1)]
    counts = Counter(filled)
    numbers: Counter[str] = Counter()
    distinct = []
    for name in filled:
        numbers[name] += 1
        distinct.append(name if counts[name] == 1 else f"{name} ({numbers[name]})")
    return distinct


def _group_of_table(table: TextTable) -> Group:
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
        first_rows = column.first_rows().items()
        add_texts(
            group, name, column, {text: f"line {lines[row]}, column {k + 1}" for text, row in first_rows}
        )
    return group


def _stated_interval(table: TextTable) -> dict[str, str]:
    """Return the sampling interval that LabVIEW states above a table, as a fact."""
    for line in table.heading[: table.layout.header_line]:
        name, number = [*cells_of(line, table.dialect.delimiter), "", ""][:2]
        if name == INTERVAL and not table.cells.is_text(number):
            return {INTERVAL: f"{table.cells.column([number]).numbers[0]:.12g}"}
    return {}


_MOST_MARKS: Final = 3
"""Different texts among the numbers of a channel that are taken for marks of missing samples; chosen."""


def _read_by_detected_dialect(path: Path, stated: Dialect) -> Contents:
    """Read a table by the dialect that it shows, where `stated` does not read it.

    `Contents.dialect` says which, `guesses` why a setting of it is one. Raises UnreadableError where there is
    no table.
    """
    dialect, guesses = _dialect_of_heading(path, replace(stated, by_itself=False))
    contents, refined = read(path, dialect), dialect
    while (more := _dialect_refined_by_cells(contents.groups[0], refined)) != refined:
        contents, refined = read(path, more), more
    for setting, reason in (("thousands", "groups of three digits"), ("missing", "texts among numbers")):
        if getattr(refined, setting) != getattr(dialect, setting):
            guesses[setting] = reason
    return replace(contents, guesses=guesses)


def _dialect_of_heading(path: Path, stated: Dialect) -> tuple[Dialect, dict[str, str]]:
    """Return the dialect that the first lines of a file show, and its guesses: setting -> reason."""
    guesses: dict[str, str] = {}
    try:
        heading = heading_of(path, encoding_of(path, stated.encoding), stated)
    except UnicodeError as error:
        if stated.encoding == OF_WINDOWS:
            raise UnreadableError(undecodable(path, OF_WINDOWS)) from error
        dialect, guesses = _dialect_of_heading(path, replace(stated, encoding=OF_WINDOWS))
        return dialect, {**guesses, "encoding": f"it is not {stated.encoding}"}
    layout, likely = likely_layout(heading, stated)
    if layout.alike:
        guesses["header_line"] = f"or {', '.join(map(str, layout.alike))}, which are as wide"
        likely = replace(likely, header_line=layout.header_line)
    samples = (line for line in heading[layout.first_line - 1 :] if not line.startswith(COMMENT))
    rows = [cells_of(line, likely.delimiter) for line in samples]
    columns = [{cell.lstrip("+-") for cell in column} for column in zip_longest(*rows, fillvalue="")]
    if not likely.thousands and _may_group_digits(columns, likely.decimal):
        if not _groups_digits(columns, likely.decimal):
            return likely, {**guesses, "decimal": "or it groups digits: three stand behind it in all numbers"}
        other = "," if likely.decimal == "." else "."
        guesses["thousands"] = f"it stands in numbers from 1{likely.decimal}000 on alone"
        likely = replace(likely, thousands=likely.decimal, decimal=other)
    return likely, guesses


def _may_group_digits(columns: Sequence[Set[str]], sign: str) -> bool:
    """Return whether all numbers with a sign have it where it would group their digits."""
    numbers = (cell for column in columns for cell in column if cell.replace(sign, "").isdigit())
    signed = [cell for cell in numbers if sign in cell]
    return bool(signed) and all(grouping_of(cell) == sign and not cell.startswith("0") for cell in signed)


def _groups_digits(columns: Sequence[Set[str]], sign: str) -> bool:
    """Return whether a column has numbers with the sign, and smaller ones without it."""
    return any(
        any(sign in cell for cell in column) and any(cell.isdigit() and len(cell) <= 3 for cell in column)
        for column in columns
    )


def _dialect_refined_by_cells(group: Group, dialect: Dialect) -> Dialect:
    """Return a dialect with the decimal comma, groups of digits or marks that texts among numbers show."""
    texts_among_numbers = [text for name in group.numbers for text in group.first_texts.get(name, {})]
    comma = Cells(",")
    if dialect.decimal == "." and any(
        comma.is_number(text) and not grouping_of(text) for text in texts_among_numbers
    ):
        return replace(dialect, decimal=",")
    for name, numbers in group.numbers.items():
        texts = group.channels[name]
        signs = {text: grouping_of(text) for text in np.unique(texts).tolist() if text}
        grouped = set(signs.values()) - {"", dialect.decimal}
        if len(grouped) == 1 and not dialect.thousands:
            dialect = replace(dialect, thousands=grouped.pop())
        marks = [text for text in signs if dialect.cells.is_text(text)]
        rare = 2 * np.isin(texts, marks).sum() < np.isfinite(numbers).sum() and len(marks) <= _MOST_MARKS
        if rare and not any(len(mark) == 1 and mark.isalpha() for mark in marks):  # which names a state
            dialect = replace(dialect, missing=(*dialect.missing, *marks))
    return dialect
