"""What separates the cells of a table that is not of the declared dialect, for a message that helps."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence

from uictest.recording.formats.dialect import COMMENT, Dialect

_SEPARATORS = (";", "\t", "|", ",")
_DECIMAL_COMMA = re.compile(r"[-+]?\d+,\d+(?:[eE][-+]?\d+)?")


def refusal(heading: Sequence[str], header_line: int, dialect: Dialect) -> str:
    """Return what to declare instead where a table is separated otherwise than declared; else an empty text.

    `heading` are the first lines of the file, `header_line` counts the one of the names from one.
    """
    if header_line > len(heading):
        return ""
    header, rows = heading[header_line - 1], _content(heading[header_line:])
    cells, separator = max((header.count(each), each) for each in _SEPARATORS if each != dialect.delimiter)
    if cells <= header.count(dialect.delimiter) or any(row.count(separator) != cells for row in rows[-1:]):
        return ""
    comma = any(_DECIMAL_COMMA.fullmatch(cell.strip()) for row in rows for cell in row.split(separator))
    return _advice(separator, "," if comma and separator != "," else ".")


def _advice(separator: str, decimal: str) -> str:
    name = {"\t": "tabs"}.get(separator, f"'{separator}'")
    commas = " with decimal commas" if decimal == "," else ""
    keys = f"delimiter: {json.dumps(separator)}, decimal: {json.dumps(decimal)}"
    return f"the table looks separated by {name}{commas}: set csv: {{{keys}}} in a channel map (--map)"


def _content(lines: Sequence[str]) -> list[str]:
    return [line for line in lines if line.strip() and not line.startswith(COMMENT)]
