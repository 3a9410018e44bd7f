"""Recordings as text tables of a declared dialect."""

from __future__ import annotations

import csv
import io
import itertools
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from uictest.recording.atomic import write_text_atomic
from uictest.recording.contents import Contents, Group, Samples
from uictest.recording.formats.dialect import COMMENT, Dialect
from uictest.recording.formats.limits import MOST_CHANNELS, MOST_VALUES
from uictest.recording.formats.problems import UnreadableError
from uictest.recording.formats.separation import refusal
from uictest.recording.formats.unit_in_name import name_and_unit

if TYPE_CHECKING:
    from uictest.recording.recording import Recording

_HEADING = 1000
"""Most lines before the first sample."""
_LONGEST_LINE = 2**20
_LONGEST_TEXT = 64
_DIGITS = 10


def read(path: Path, dialect: Dialect | None = None) -> Contents:
    """Read a table; lines that begin with `#` are comments, `# key: value` among them facts.

    A cell that is no number makes its channel one of texts: a channel map says what they mean.

    Raises UnreadableError where the file is no table of this dialect.
    """
    dialect = dialect or Dialect()
    try:
        heading = _heading(path, dialect)
        header_line = dialect.header_line or _first_content(heading)
        if otherwise := refusal(heading, header_line, dialect):
            raise UnreadableError(otherwise)
        names = _cells(heading, header_line, dialect)
        units = _cells(heading, dialect.unit_line, dialect) if dialect.unit_line else []
        names, units = _named(names, units)
        first = dialect.first_line or max(header_line, dialect.unit_line) + 1
        columns = _columns(path, dialect, first, len(names))
    except (UnicodeError, LookupError, csv.Error) as error:
        raise UnreadableError(f"not a text in {dialect.encoding}: {error}") from error
    channels = dict(zip(names, columns, strict=True))
    return Contents(
        (Group("", channels, {name: unit for name, unit in zip(names, units, strict=True) if unit}),),
        _facts(heading),
    )


def write(recording: Recording, path: Path) -> None:
    """Write a recording with its facts as comments above it. Raises OSError."""
    text = io.StringIO(newline="")
    for key, value in recording.metadata.items():
        text.write(f"{COMMENT} {_one_line(key)}: {_one_line(value)}\n")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(f"{name} [{recording.units[name]}]" for name in recording.channels)
    columns = [[f"{value:.{_DIGITS}g}" for value in samples] for samples in recording.channels.values()]
    writer.writerows(zip(*columns, strict=True))
    write_text_atomic(path, text.getvalue())


def _one_line(text: str) -> str:
    return " ".join(text.split())


def _heading(path: Path, dialect: Dialect) -> list[str]:
    """Return the first lines; enough of them to hold every declared one."""
    wanted = max(dialect.header_line, dialect.unit_line, dialect.first_line, _HEADING)
    with path.open(encoding=dialect.encoding, newline="") as file:
        lines = list(
            itertools.islice(iter(lambda: file.readline(_LONGEST_LINE), ""), min(wanted, 10 * _HEADING))
        )
    if any(len(line) >= _LONGEST_LINE for line in lines):
        raise UnreadableError(f"a line of more than {_LONGEST_LINE} characters")
    return lines


def _first_content(heading: Sequence[str]) -> int:
    for number, line in enumerate(heading, start=1):
        if line.strip() and not line.startswith(COMMENT):
            return number
    raise UnreadableError("no line but comments")


def _cells(heading: Sequence[str], number: int, dialect: Dialect) -> list[str]:
    if number > len(heading):
        raise UnreadableError(f"the file has no line {number}")
    return [cell.strip() for cell in next(csv.reader([heading[number - 1]], delimiter=dialect.delimiter), [])]


def _named(names: list[str], units: list[str]) -> tuple[list[str], list[str]]:
    """Return names, made distinct, and their units."""
    if not units:
        names, units = map(list, zip(*map(name_and_unit, names), strict=True)) if names else ([], [])
    if not names or len(names) > MOST_CHANNELS:
        raise UnreadableError(f"{len(names)} columns; expected 1 to {MOST_CHANNELS}")
    units = [*units, *[""] * len(names)][: len(names)]
    units = [unit.strip("[]() ") for unit in units]
    met: dict[str, int] = {}
    distinct = []
    for position, name in enumerate(names, start=1):
        name = name or f"column {position}"
        met[name] = met.get(name, 0) + 1
        distinct.append(name if met[name] == 1 else f"{name} ({met[name]})")
    return distinct, units


def _columns(path: Path, dialect: Dialect, first: int, width: int) -> list[Samples]:
    import pandas as pd

    try:
        table = pd.read_csv(
            path,
            sep=dialect.delimiter,
            decimal=dialect.decimal,
            encoding=dialect.encoding,
            skiprows=first - 1,
            header=None,
            names=range(width),
            index_col=False,
            comment=COMMENT,
            skip_blank_lines=True,
            nrows=MOST_VALUES // width + 1,
            low_memory=False,
            on_bad_lines="error",
        )
    except (ValueError, OverflowError) as error:
        if isinstance(error, UnicodeError):
            raise
        raise UnreadableError(f"not a table from line {first} on: {str(error).strip()}") from error
    if len(table) * width > MOST_VALUES:
        raise UnreadableError(f"more than {MOST_VALUES} values")
    return [_samples(table[k]) for k in range(width)]


def _samples(column: Any) -> Samples:
    if column.dtype.kind in "biuf":
        return np.asarray(column, dtype=np.float64)
    return np.array([str(cell)[:_LONGEST_TEXT] if cell == cell else "" for cell in column], dtype=np.str_)


def _facts(heading: Sequence[str]) -> dict[str, str]:
    return dict(_fact_lines(heading))


def _fact_lines(heading: Sequence[str]) -> Iterator[tuple[str, str]]:
    for line in heading:
        key, colon, value = line.removeprefix(COMMENT).partition(":")
        if line.startswith(COMMENT) and colon and key.strip():
            yield key.strip(), value.strip()
