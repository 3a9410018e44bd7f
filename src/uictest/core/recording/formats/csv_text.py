"""Recordings as text tables of a declared dialect.

The lines of samples are checked one by one before a library parses them.
"""

from __future__ import annotations

import csv
import io
import itertools
import math
import re
from bisect import bisect_right
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TextIO

import numpy as np

from uictest.core.recording.formats.file_formats import MOST_CHANNELS, MOST_VALUES, UnreadableError
from uictest.core.recording.formats.layout import (
    COMMENT,
    MARK,
    Dialect,
    TableLayout,
    cells_of,
    encoding_of,
    name_and_unit,
    table_layout,
    undecodable,
)
from uictest.core.recording.recording import Contents, Group, Recording, Samples

LONGEST_LINE = 2**20
"""characters"""
_HEADING = 1000
"""Most lines before the first sample."""
_LONGEST_TEXT = 64
_DIGITS = 10
_DATE = re.compile(r"\s*\d{4}-\d\d-\d\d[T ]\d\d:\d\d(?::\d\d.*)?")


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


def read(path: Path, dialect: Dialect | None = None) -> Contents:
    """Read a table; lines that begin with `#` are comments, `# key: value` among them facts.

    A cell that is no number makes its channel one of texts: a channel map says what they mean. Dates become
    seconds after the first.

    Raises UnreadableError where the file is no table of this dialect.
    """
    dialect = dialect or Dialect()
    encoding = encoding_of(path, dialect.encoding)
    try:
        heading = heading_of(path, encoding, dialect)
        layout = table_layout(heading, dialect)
        names, units = names_and_units(heading, layout, dialect)
        lines = sample_lines(path, encoding, dialect, layout, len(names))
        group = _group(names, units, _table(path, encoding, dialect, lines), lines)
    except UnicodeError as error:
        raise UnreadableError(undecodable(path, encoding)) from error
    except csv.Error as error:
        raise UnreadableError(f"not a table: {error}") from error
    return Contents((group,), _facts(heading))


def encoded(recording: Recording) -> bytes:
    """Return a recording with its facts as comments above it."""
    text = io.StringIO(newline="")
    for key, value in recording.metadata.items():
        text.write(f"{COMMENT} {_one_line(key)}: {_one_line(value)}\n")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(f"{name} [{recording.units[name]}]" for name in recording.channels)
    columns = [[f"{value:.{_DIGITS}g}" for value in samples] for samples in recording.channels.values()]
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
    return [lines[0].removeprefix(MARK), *lines[1:]] if lines else []


def names_and_units(
    heading: Sequence[str], layout: TableLayout, dialect: Dialect
) -> tuple[list[str], list[str]]:
    """Return names, made distinct, and their units: those in the names, else those of the line of units."""
    named = [name_and_unit(cell) for cell in _cells(heading, layout.header_line, dialect)]
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


def _table(path: Path, encoding: str, dialect: Dialect, lines: SampleLines) -> Any:
    """Return the samples as a data frame whose columns are counted from zero."""
    import pandas as pd

    try:
        return pd.read_csv(
            path,
            sep=dialect.delimiter,
            decimal=dialect.decimal,
            thousands=dialect.thousands or None,
            encoding=encoding,
            skiprows=[number - 1 for number in lines.skipped],
            header=None,
            names=range(lines.width),
            index_col=False,
            skipinitialspace=True,
            skip_blank_lines=False,
            low_memory=False,
        )
    except (ValueError, OverflowError) as error:
        if isinstance(error, UnicodeError):
            raise
        raise UnreadableError(f"not a table from line {lines.number(0)} on") from error


def _group(names: Sequence[str], units: Sequence[str], table: Any, lines: SampleLines) -> Group:
    channels: dict[str, Samples] = {}
    stated = {name: unit for name, unit in zip(names, units, strict=True) if unit}
    first_texts: dict[str, str] = {}
    for position, name in enumerate(names):
        column = table[position]
        if (seconds := _seconds(column)) is not None:
            channels[name], stated[name] = seconds, "s"
            continue
        channels[name] = _samples(column)
        if (row := _first_text(column)) is not None:
            first_texts[name] = f"line {lines.number(row)}, column {position + 1}"
    return Group("", channels, stated, first_texts=first_texts)


def _samples(column: Any) -> Samples:
    if column.dtype.kind in "biuf":
        return np.asarray(column, dtype=np.float64)
    return np.array([str(cell)[:_LONGEST_TEXT] if cell == cell else "" for cell in column], dtype=np.str_)


def is_date(text: str) -> bool:
    """Return whether a text is a date with a time."""
    return _DATE.fullmatch(text) is not None


def _seconds(column: Any) -> Samples | None:
    """Return dates and times as seconds after the first, NaN where there is none; None for other columns."""
    import pandas as pd

    texts = column.dropna()
    if column.dtype.kind in "biuf" or not len(texts) or not _DATE.fullmatch(str(texts.iloc[0])):
        return None
    stamps = pd.to_datetime(column, format="ISO8601", errors="coerce", utc=True)
    if stamps.isna().sum() > column.isna().sum():
        return None
    return np.asarray((stamps - stamps.dropna().iloc[0]).dt.total_seconds(), dtype=np.float64)


def _first_text(column: Any) -> int | None:
    """Return the row of the first text in a column that also holds numbers, else None."""
    if column.dtype.kind in "biuf":
        return None
    numbers = np.array([_is_number(cell) for cell in column])
    texts = np.flatnonzero(~numbers & column.notna().to_numpy())
    return int(texts[0]) if len(texts) and numbers.any() else None


def _is_number(cell: object) -> bool:
    try:
        return not math.isnan(float(str(cell)))
    except ValueError:
        return False


def _facts(heading: Sequence[str]) -> dict[str, str]:
    return dict(_fact_lines(heading))


def _fact_lines(heading: Sequence[str]) -> Iterator[tuple[str, str]]:
    for line in heading:
        key, colon, value = line.removeprefix(COMMENT).partition(":")
        if line.startswith(COMMENT) and colon and key.strip():
            yield key.strip(), value.strip()
