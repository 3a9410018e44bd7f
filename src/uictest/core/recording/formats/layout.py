"""Where a text table has its dialect, encoding, names, units and samples."""

from __future__ import annotations

import codecs
import csv
import json
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Final

from uictest.core.recording.formats.file_formats import MOST_CHANNELS, UnreadableError

COMMENT = "#"


@dataclass(frozen=True, slots=True)
class Dialect:
    """The dialect of a CSV file. The default is that of the files this program writes.

    Lines are counted from one, as an editor counts them.

    Args:
        delimiter: the character between two cells.
        decimal: the character before decimals, `.` or `,`.
        thousands: the character between groups of three digits; empty: none.
        header_line: the line of the channels' names; 0: the first that is no comment.
        unit_line: the line of their units; 0: the line after the names where it holds units; units may also
            stand in the names, as in `speed [m/s]`.
        first_line: the first line of samples; 0: the one after names and units.
        encoding: of the text, where it does not begin with a byte-order mark.

    """

    delimiter: str = ","
    decimal: str = "."
    thousands: str = ""
    header_line: int = 0
    unit_line: int = 0
    first_line: int = 0
    encoding: str = "utf-8"

    def changes_to(self, other: Dialect) -> str:
        """Return the `csv` section with the settings of another dialect that differ from this one."""
        declared = asdict(self)
        changes = {name: value for name, value in asdict(other).items() if value != declared[name]}
        return f"csv: {{{', '.join(f'{name}: {json.dumps(value)}' for name, value in changes.items())}}}"


_NAME_AND_UNIT = re.compile(r"\s*(?P<name>.*?)\s*(?:\[(?P<square>[^\[\]]*)\]|\((?P<round>[^()]*)\))\s*")
_SEPARATORS: Final = (";", "\t", "|", ",")
_LAST_ROWS: Final = 5
"""Lines of which the one with most numbers shows what a row of samples looks like; chosen."""
_WITH_POINT: Final = re.compile(
    r"[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?|[-+]?(?:nan|inf)", re.ASCII | re.IGNORECASE
)
_WITH_COMMA: Final = re.compile(r"[-+]?\d+,\d+(?:e[-+]?\d+)?", re.ASCII | re.IGNORECASE)
_BRACKETED: Final = re.compile(r"\[[^\[\]]*\]|\([^()]*\)")
_USUAL_UNIT: Final = re.compile(
    "[mµun]?s|sec|min|h|[km]?m|(?:km|m)/(?:s|h)|km/?h|kph|mph|m/s[2²]|g|m?bar|[kM]?Pa|k?N|k?N ?m|%|1|-|m?[VA]"
    "|Hz|rpm|1/min|1/s|°C|degC|K|l/min",
    re.IGNORECASE,
)
"""Symbols that make a line one of units."""


@dataclass(frozen=True, slots=True)
class TableLayout:
    """Lines of a table, counted from one; `unit_line` is 0 where no line holds units."""

    header_line: int
    unit_line: int
    first_line: int


def table_layout(heading: Sequence[str], dialect: Dialect) -> TableLayout:
    """Return where the table stands whose first lines are `heading`.

    Raises UnreadableError where it is not of the declared dialect; the message says what to declare.
    """
    _reject_width(heading)
    lines = dict(_content(heading, dialect))
    if not lines:
        raise UnreadableError("the file holds no table: every line is blank or a comment")
    row, likely = _sample_row(lines, dialect)
    above, samples = _above_samples(lines, row, likely.delimiter)
    names = dialect.header_line or _names_line(above)
    units = dialect.unit_line or next((n for n in above if n > names and _holds_units(above[n])), 0)
    first = dialect.first_line or max(names, units) + 1
    if samples and names != min(lines):
        likely = replace(likely, header_line=names)
    if samples and any(first <= n < samples for n in lines):
        likely = replace(likely, first_line=samples)
    if likely != dialect:
        raise UnreadableError(_advice(dialect, likely))
    return TableLayout(names, units, first)


def _content(heading: Sequence[str], dialect: Dialect) -> Iterator[tuple[int, str]]:
    separator = "" if dialect.thousands == dialect.delimiter else dialect.thousands
    for number, line in enumerate(heading, start=1):
        if line.strip() and not line.startswith(COMMENT):
            yield number, line.replace(separator, "") if separator else line


def cells_of(line: str, delimiter: str) -> list[str]:
    """Return the cells of one line, without blanks around them. Raises csv.Error."""
    return [cell.strip() for cell in next(csv.reader([line], delimiter=delimiter), [])]


def _reject_width(heading: Sequence[str]) -> None:
    for number, line in enumerate(heading, start=1):
        cells = 1 + max(map(line.count, _SEPARATORS))
        if cells > MOST_CHANNELS:
            raise UnreadableError(f"line {number} has {cells} cells; at most {MOST_CHANNELS} are read")


def _sample_row(lines: Mapping[int, str], dialect: Dialect) -> tuple[list[str], Dialect]:
    """Return a row of samples, and the dialect that makes most of its cells numbers."""
    separators = dict.fromkeys((dialect.delimiter, *_SEPARATORS))
    last = list(lines.values())[-_LAST_ROWS:]
    rows = [(cells_of(line, separator), separator) for separator in separators for line in last]
    row, delimiter = max(rows, key=lambda pair: _likelihood(pair[0]))
    likely = replace(dialect, delimiter=delimiter)
    return row, replace(likely, decimal=_decimal(row, likely))


def _likelihood(row: Sequence[str]) -> tuple[float, int]:
    return sum(map(_is_number, row)) / max(len(row), 1), len(row)


def _decimal(row: Sequence[str], dialect: Dialect) -> str:
    commas = sum(_WITH_COMMA.fullmatch(cell) is not None for cell in row)
    points = sum("." in cell and _WITH_POINT.fullmatch(cell) is not None for cell in row)
    if dialect.delimiter == "," or dialect.thousands or commas == points:
        return dialect.decimal
    return "," if commas > points else "."


def _above_samples(
    lines: Mapping[int, str], row: Sequence[str], delimiter: str
) -> tuple[dict[int, list[str]], int]:
    """Return the rows above the first row of samples, and the line of that; 0 where there is none."""
    numeric = [k for k, cell in enumerate(row) if _is_number(cell)]
    above: dict[int, list[str]] = {}
    for number, line in lines.items():
        cells = cells_of(line, delimiter)
        if _is_sample_row(cells, numeric):
            return above, number
        above[number] = cells
    return dict(list(above.items())[:1]), 0


def _is_sample_row(row: Sequence[str], numeric: Sequence[int]) -> bool:
    """Return whether a row has numbers where rows of samples have them, a few texts and blanks aside."""
    cells = [row[k] for k in numeric if k < len(row)]
    texts = [bool(cell) and not _is_number(cell) for cell in cells]
    return any(map(_is_number, cells)) and not texts[0] and 2 * sum(texts) <= len(texts)


def _names_line(above: Mapping[int, Sequence[str]]) -> int:
    """Return the line with most names; of several the first, for units stand below names."""
    if not above:
        raise UnreadableError("no line of names stands above the samples: write one")
    return max(above, key=lambda n: sum(map(bool, above[n])))


def _holds_units(row: Sequence[str]) -> bool:
    cells = [cell for cell in row if cell]
    units = sum(bool(_BRACKETED.fullmatch(cell) or _USUAL_UNIT.fullmatch(cell)) for cell in cells)
    return bool(cells) and 2 * units >= len(cells)


def _is_number(cell: str) -> bool:
    return _WITH_POINT.fullmatch(cell) is not None or _WITH_COMMA.fullmatch(cell) is not None


def _advice(declared: Dialect, likely: Dialect) -> str:
    seems = []
    if (likely.delimiter, likely.decimal) != (declared.delimiter, declared.decimal):
        name = {"\t": "tabs"}.get(likely.delimiter, f"'{likely.delimiter}'")
        commas = " with decimal commas" if likely.decimal == "," else ""
        seems.append(f"be separated by {name}{commas}")
    if likely.header_line != declared.header_line:
        seems.append(f"have its names in line {likely.header_line}")
    if likely.first_line != declared.first_line:
        seems.append(f"begin its samples in line {likely.first_line}")
    section = declared.changes_to(likely)
    return f"the table seems to {' and '.join(seems)}: set {section} in a channel map (--map)"


def name_and_unit(text: str) -> tuple[str, str]:
    """Return the name and the unit in brackets at its end; an empty unit where there is none."""
    match = _NAME_AND_UNIT.fullmatch(text[:500])
    if match is None or not match["name"]:
        return text.strip(), ""
    return match["name"], (match["square"] or match["round"] or "").strip()


_BYTE_ORDER_MARKS: Final = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF16_LE, "utf-16-le"),
    (codecs.BOM_UTF16_BE, "utf-16-be"),
)
_COMPRESSED: Final = (
    (b"\x1f\x8b", "gzip"),
    (b"PK\x03\x04", "zip"),
    (b"BZh", "bzip2"),
    (b"\xfd7zX", "xz"),
    (b"\x28\xb5\x2f\xfd", "zstd"),
)
MARK: Final = "\ufeff"
"""The byte-order mark as a character: UTF-16 of a named byte order keeps it at the start of the text."""


def encoding_of(path: Path, stated: str) -> str:
    """Return the encoding of a byte-order mark, else the stated one.

    Raises OSError, and UnreadableError for a compressed file.
    """
    with path.open("rb") as file:
        beginning = file.read(4)
    if packed := next((name for mark, name in _COMPRESSED if beginning.startswith(mark)), ""):
        raise UnreadableError(f"compressed by {packed}: unpack it")
    return next((name for mark, name in _BYTE_ORDER_MARKS if beginning.startswith(mark)), stated)


def undecodable(path: Path, encoding: str) -> str:
    """Return where a file does not match its encoding, and what to write instead. Raises OSError."""
    content = path.read_bytes()
    try:
        content.decode(encoding)
    except UnicodeDecodeError as error:
        before = content[: error.start].decode(encoding, "replace")
        start = max(before.rfind("\n"), before.rfind("\r")) + 1
        line = 1 + before.count("\n") + before.count("\r") - before.count("\r\n")
        byte = 1 + len(before[start:].lstrip(MARK).encode(encoding.removesuffix("-sig"), "replace"))
        wrong = f"line {line}, byte {byte}: {content[error.start]:#04x} is not {_shown(encoding)}"
        return f"{wrong}; {encoding_advice(encoding)} in a channel map (--map)"
    return f"not a text in {_shown(encoding)}"


def _shown(encoding: str) -> str:
    return encoding.removesuffix("-sig").upper()


def encoding_advice(encoding: str) -> str:
    """Return what to write where a file does not have an encoding."""
    if encoding.startswith("utf"):
        return "for a file of a Windows program, write csv: {encoding: cp1252}"
    return "write the file's encoding in csv: {encoding: ...}"
