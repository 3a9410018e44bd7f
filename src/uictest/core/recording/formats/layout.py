"""Where a text table has its dialect, encoding, names, units and samples."""

from __future__ import annotations

import codecs
import csv
import json
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any, Final

from uictest.core.recording.formats.cells import Cells, grouping_of
from uictest.core.recording.formats.file_formats import MOST_CHANNELS, UnreadableError
from uictest.core.units import is_recorded_unit

COMMENT = "#"
END_OF_HEADER: Final = "***End_of_Header***"
"""Line of LabVIEW's text files above the table, after the header of the file and that of a segment."""
_SEGMENT: Final = "Channels"
"""How the header of a segment begins."""
OF_WINDOWS: Final = "cp1252"
"""Encoding of most Windows programs that write no UTF-8."""


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
        missing: marks of missing samples, besides the usual ones.
        by_itself: find out the dialect where the stated one does not read the file.

    """

    delimiter: str = ","
    decimal: str = "."
    thousands: str = ""
    header_line: int = 0
    unit_line: int = 0
    first_line: int = 0
    encoding: str = "utf-8"
    missing: tuple[str, ...] = ()
    by_itself: bool = False

    @classmethod
    def of(cls, form: Mapping[str, Any]) -> Dialect:
        """Return the dialect of a form that went through JSON, where a tuple is a list."""
        return cls(**{**form, "missing": tuple(form["missing"])})

    @property
    def cells(self) -> Cells:
        """The reader of the cells of such a file."""
        return Cells(self.decimal, self.thousands, self.missing)

    def settings(self, other: Dialect) -> dict[str, Any]:
        """Return the settings that differ from those of another dialect."""
        theirs = asdict(other)
        return {name: value for name, value in asdict(self).items() if value != theirs[name]}


_SEPARATORS: Final = (";", "\t", "|", ",")
_LAST_ROWS: Final = 5
"""Lines of which the one with most numbers shows what a row of samples looks like; chosen."""
_BY_DECIMAL: Final = {sign: Cells(sign) for sign in (".", ",")}
_BRACKETED: Final = re.compile(r"\[[^\[\]]*\]|\([^()]*\)")
_USUAL_UNIT: Final = re.compile(
    "[mµun]?s|sec|min|h|[km]?m|(?:km|m)/(?:s|h)|km/?h|kph|mph|m/s[2²]|g|m?bar|[kM]?Pa|k?N|k?N ?m|%|1|-|m?[VA]"
    "|Hz|rpm|1/min|1/s|°C|degC|K|l/min",
    re.IGNORECASE,
)
"""Symbols that make a line one of units."""


@dataclass(frozen=True, slots=True)
class TableLayout:
    """Lines of a table, counted from one; `unit_line` is 0 where no line holds units.

    `alike` are other lines that may be those of the names, for they are as wide.
    """

    header_line: int
    unit_line: int
    first_line: int
    alike: tuple[int, ...] = ()


def table_layout(heading: Sequence[str], dialect: Dialect) -> TableLayout:
    """Return the layout of the table whose first lines are `heading`.

    Raises UnreadableError where it is not of the declared dialect; the message says what to declare.
    """
    layout, likely = likely_layout(heading, dialect)
    if likely != dialect:
        raise UnreadableError(_dialect_advice(dialect, likely))
    return layout


def likely_layout(heading: Sequence[str], dialect: Dialect) -> tuple[TableLayout, Dialect]:
    """Return the layout of a table by a dialect, and the dialect by which it is a table of samples.

    Raises UnreadableError for a file without a table.
    """
    for number, line in enumerate(heading, start=1):
        if (cells := 1 + max(map(line.count, _SEPARATORS))) > MOST_CHANNELS:
            raise UnreadableError(f"line {number} has {cells} cells; at most {MOST_CHANNELS} are read")
    lines = dict(_numbered_content_lines(heading, dialect))
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
    filled = {n: sum(map(bool, cells)) for n, cells in above.items() if not _holds_units(cells)}
    alike = [n for n, count in filled.items() if n != names and count == filled.get(names)]
    return TableLayout(names, units, first, () if dialect.header_line else tuple(alike)), likely


def _numbered_content_lines(heading: Sequence[str], dialect: Dialect) -> Iterator[tuple[int, str]]:
    separator = "" if dialect.thousands == dialect.delimiter else dialect.thousands
    begin = _labview_header_length(heading)
    for number, line in enumerate(heading[begin:], start=begin + 1):
        if line.strip() and not line.startswith(COMMENT):
            yield number, line.replace(separator, "") if separator else line


def _labview_header_length(heading: Sequence[str]) -> int:
    """Return the number of lines of LabVIEW's headers, of the file and of its first segment."""
    ends = [number for number, line in enumerate(heading, start=1) if line.startswith(END_OF_HEADER)]
    for end in ends:
        if not next((line for line in heading[end:] if line.strip()), "").startswith(_SEGMENT):
            return end
    return max(ends, default=0)


def cells_of(line: str, delimiter: str) -> list[str]:
    """Return the cells of one line, without blanks around them. Raises csv.Error."""
    return [cell.strip() for cell in next(csv.reader([line], delimiter=delimiter), [])]


def _sample_row(lines: Mapping[int, str], dialect: Dialect) -> tuple[list[str], Dialect]:
    """Return a row of samples, and the dialect that makes most of its cells numbers."""
    separators = dict.fromkeys((dialect.delimiter, *_SEPARATORS))
    last = list(lines.values())[-_LAST_ROWS:]
    declared = max((cells_of(line, dialect.delimiter) for line in last), key=_rank_as_samples)
    if not any(map(dialect.cells.is_text, declared)) and _rank_as_samples(declared)[0] == 1.0:
        return declared, dialect
    rows = [(cells_of(line, separator), separator) for separator in separators for line in last]
    row, delimiter = max(rows, key=lambda pair: _rank_as_samples(pair[0]))
    likely = replace(dialect, delimiter=delimiter)
    return row, replace(likely, decimal=_decimal_of_row(row, likely))


def _rank_as_samples(row: Sequence[str]) -> tuple[float, int]:
    filled = [cell for cell in row if cell]
    return sum(map(_is_number, filled)) / max(len(filled), 1), len(row)


def _decimal_of_row(row: Sequence[str], dialect: Dialect) -> str:
    """Return the decimal sign of a row; with three digits after it in all cells it may group digits."""
    if dialect.delimiter == "," or dialect.thousands:
        return dialect.decimal
    signed = [(s, cell) for cell in row for s in ",." if s in cell and _BY_DECIMAL[s].is_number(cell)]
    clear = [sign for sign, cell in signed if not grouping_of(cell)] or [sign for sign, _ in signed]
    commas, points = map(clear.count, ",.")
    # A declared comma that stands in a number is believed: a cell written otherwise is named.
    if commas == points or (dialect.decimal == "," and any(sign == "," for sign, _ in signed)):
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
    return cell.lower() == "nan" or any(cells.is_number(cell) for cells in _BY_DECIMAL.values())


def _dialect_advice(declared: Dialect, likely: Dialect) -> str:
    seems = []
    if (likely.delimiter, likely.decimal) != (declared.delimiter, declared.decimal):
        name = {"\t": "tabs"}.get(likely.delimiter, f"'{likely.delimiter}'")
        commas = " with decimal commas" if likely.decimal == "," else ""
        seems.append(f"be separated by {name}{commas}")
    if likely.header_line != declared.header_line:
        seems.append(f"have its names in line {likely.header_line}")
    if likely.first_line != declared.first_line:
        seems.append(f"begin its samples in line {likely.first_line}")
    settings = ", ".join(f"{name}: {json.dumps(value)}" for name, value in likely.settings(declared).items())
    section = f"csv: {{{settings}}}"
    return (
        f"the table seems to {' and '.join(seems)}: set {section} in a channel map (--map of evaluate,"
        " log, fit), or let 'uictest evaluate FILE --write-map MAP' write it"
    )


def names_and_units_of(headings: Sequence[str]) -> list[tuple[str, str]]:
    """Return names and the units in brackets after them; an empty unit where the brackets hold none.

    Brackets that tell channels apart, as in `v[0]`, `v[1]`, are part of the names.
    """
    parts = [_name_and_brackets(heading.strip()) for heading in headings]
    whole = {name.strip() for name, text in parts if not _is_unit(name, text)}
    return [
        (heading.strip(), "") if name.strip() in whole else (name.strip(), text.strip())
        for heading, (name, text) in zip(headings, parts, strict=True)
    ]


def _name_and_brackets(heading: str) -> tuple[str, str]:
    """Return what stands before the unit or the brackets at the end of a heading, and these."""
    for word in (" in ", " / "):  # as DIN 461 writes units
        name, _, text = heading.rpartition(word)
        if name and text.strip() != "1" and is_recorded_unit(text.strip()):
            return name.rstrip(" /") + " ", text
    opening = {"]": "[", ")": "("}.get(heading[-1:], "")
    name, bracket, text = heading[:-1].rpartition(opening) if opening else (heading, "", "")
    whole = bracket and name.strip() and heading[-1] not in text
    return (name.rstrip("/ ") + name[len(name.rstrip()) :], text) if whole else (heading, "")


def _is_unit(name: str, text: str) -> bool:
    """Return whether the text in brackets after a name is a unit; that of `v[1]` is an index."""
    if text.strip() == "1":
        return name.endswith(" ")
    return (
        not text.strip() or is_recorded_unit(text.strip()) or _USUAL_UNIT.fullmatch(text.strip()) is not None
    )


_BYTE_ORDER_MARKS: Final = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF16_LE, "utf-16-le"),
    (codecs.BOM_UTF16_BE, "utf-16-be"),
)
BYTE_ORDER_MARK: Final = "\ufeff"
"""The byte-order mark as a character: UTF-16 of a named byte order keeps it at the start of the text."""


def encoding_of(path: Path, stated: str) -> str:
    """Return the encoding of a byte-order mark, else the stated one. Raises OSError."""
    with path.open("rb") as file:
        beginning = file.read(4)
    unmarked = {b"\0": "utf-16-be"}.get(beginning[:1], "utf-16-le") if beginning.count(0) == 2 else stated
    return next((name for mark, name in _BYTE_ORDER_MARKS if beginning.startswith(mark)), unmarked)


def undecodable(path: Path, encoding: str) -> str:
    """Return the message for a file that does not match its encoding, with the remedy. Raises OSError."""
    content = path.read_bytes()
    try:
        content.decode(encoding)
    except UnicodeDecodeError as error:
        before = content[: error.start].decode(encoding, "replace")
        start = max(before.rfind("\n"), before.rfind("\r")) + 1
        line = 1 + before.count("\n") + before.count("\r") - before.count("\r\n")
        in_line = before[start:].lstrip(BYTE_ORDER_MARK)
        byte = 1 + len(in_line.encode(encoding.removesuffix("-sig"), "replace"))
        wrong = f"line {line}, byte {byte}: {content[error.start]:#04x} is not {_encoding_text(encoding)}"
        return f"{wrong}; {encoding_advice(encoding)} in a channel map (--map)"
    return f"not a text in {_encoding_text(encoding)}"


def _encoding_text(encoding: str) -> str:
    return encoding.removesuffix("-sig").upper()


def encoding_advice(encoding: str) -> str:
    """Return the remedy for a file that does not match an encoding."""
    if encoding.startswith("utf"):
        return f"for a file of a Windows program, write csv: {{encoding: {OF_WINDOWS}}}"
    return "write the file's encoding in csv: {encoding: ...}"
