"""Cells of a text table: numbers as its dialect writes them, marks of missing samples, and texts."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

MISSING: Final = (
    *("", "-", "nan", "NaN", "NAN", "-nan", "-NaN", "NA", "N/A", "n/a", "#N/A", "#NA", "<NA>", "#N/A N/A"),
    *("NULL", "null", "None", "1.#IND", "-1.#IND", "1.#QNAN", "-1.#QNAN"),
)
"""What every table may write for a sample that is missing; its dialect may add others."""
LONGEST_TEXT: Final = 64
"""Characters of a text that are kept; chosen."""
MOST_PLACED: Final = 20
"""Different texts of a channel whose first places are kept; chosen."""
_BLANKS: Final = "\u00a0\u2009\u202f"
"""Blanks that stand for the plain one between groups of digits."""
_APOSTROPHE: Final = "\u2019"
_GROUPED: Final = re.compile(
    rf"[-+]?\d{{1,3}}(?:([.,' {_BLANKS}{_APOSTROPHE}])\d{{3}}(?:\1\d{{3}})*)(?:[.,]\d+)?", re.ASCII
)


class TextColumn(NamedTuple):
    """The cells of a column, each a number or a text.

    Args:
        numbers: NaN where a sample is missing or a text.
        texts: empty where it is missing or a number; none at all in a column without texts.

    """

    numbers: NDArray[np.float64]
    texts: NDArray[Any] | None

    @property
    def samples(self) -> NDArray[Any]:
        """The texts where there are some, else the numbers."""
        return self.numbers if self.texts is None else self.texts

    @property
    def is_mixed(self) -> bool:
        """Whether texts stand among numbers."""
        return self.texts is not None and not bool(np.isnan(self.numbers).all())

    def first_rows(self) -> dict[str, int]:
        """Return the first texts, and the row of each."""
        if self.texts is None:
            return {}
        texts, rows = np.unique(self.texts, return_index=True)
        in_order = sorted(zip(rows.tolist(), texts.tolist(), strict=True))
        return {text: row for row, text in in_order[:MOST_PLACED] if text}


def joined(columns: Sequence[TextColumn]) -> TextColumn:
    """Return the parts of a column as one."""
    numbers = np.concatenate([column.numbers for column in columns])
    if all(column.texts is None for column in columns):
        return TextColumn(numbers, None)
    parts = [np.zeros(len(each.numbers), "U1") if each.texts is None else each.texts for each in columns]
    return TextColumn(numbers, np.concatenate(parts))


class Cells:
    """Reads the cells of a table. There is no other reading of a cell.

    Args:
        decimal: the sign before decimals.
        thousands: the sign between groups of three digits; empty: none.
        missing: marks of a missing sample besides :data:`MISSING`.

    """

    def __init__(self, decimal: str = ".", thousands: str = "", missing: Sequence[str] = ()) -> None:
        self.marks = (
            *dict.fromkeys((*MISSING, *(mark.replace(".", decimal) for mark in MISSING), *missing)),
        )
        self._decimal, self._thousands, self._missing = decimal, thousands, tuple(missing)
        self._signs = {" ": f" {_BLANKS}", "'": f"'{_APOSTROPHE}"}.get(thousands, thousands)
        point = re.escape(decimal)
        whole = rf"\d{{1,3}}(?:[{self._signs}]\d{{3}})+|\d+" if thousands else r"\d+"
        number = rf"[-+]?(?:(?:{whole})(?:{point}\d*)?|{point}\d+)(?:[eE][-+]?\d+)?|[-+]?(?i:inf|infinity)"
        self._pattern = re.compile(rf"^(?:{number})$", re.ASCII)

    def is_number(self, cell: str) -> bool:
        """Return whether a cell is a number as the dialect writes it."""
        return self._pattern.match(cell.strip()) is not None

    def is_text(self, cell: str) -> bool:
        """Return whether a cell is neither a number nor a missing sample."""
        return cell.strip() not in self.marks and not self.is_number(cell)

    def column(self, cells: Any) -> TextColumn:
        """Return numbers and texts of some cells, an array of Arrow or texts; None is a missing sample."""
        import pyarrow as pa
        import pyarrow.compute as pc

        array = cells if isinstance(cells, pa.Array) else pa.array(cells, pa.string())
        stripped: Any = pc.utf8_trim_whitespace(array.cast(pa.string()))
        missing = pc.or_(pc.is_null(stripped), pc.is_in(stripped, value_set=pa.array(self.marks)))
        matched = pc.fill_null(pc.match_substring_regex(stripped, self._pattern.pattern), False)
        number = pc.and_not(matched, missing)  # a mark may be a number: -999
        digits = pc.if_else(number, stripped, None)
        for sign in self._signs:
            digits = pc.replace_substring(digits, sign, "")
        values = pc.cast(pc.replace_substring(digits, self._decimal, "."), pa.float64())
        numbers = np.asarray(values.to_numpy(zero_copy_only=False), dtype=np.float64)
        if pc.all(pc.or_(missing, number)).as_py() is not False:
            return TextColumn(numbers, None)
        texts = pc.if_else(pc.or_(missing, number), "", pc.utf8_slice_codeunits(stripped, 0, LONGEST_TEXT))
        return TextColumn(numbers, np.array(texts.to_pylist(), dtype=np.str_))

    def refusal(self, text: str, place: str = "") -> str:
        """Return that a cell is no number, and what to write in the channel map so that it is read."""
        stripped, sign = text.strip(), grouping_of(text)
        marks = json.dumps([*self._missing, stripped], ensure_ascii=False)
        remedy, otherwise = (
            f"if it marks a missing sample, write csv: {{missing: {marks}}}",
            ", else correct the file",
        )
        if self._decimal == "." and not self._thousands and Cells(",").is_number(stripped):
            grouped = ', or csv: {thousands: ","} if its comma groups digits' if sign else ""
            remedy, otherwise = f'for decimal commas, write csv: {{decimal: ","}}{grouped}', ""
        elif sign not in ("", self._decimal, self._thousands):
            remedy = f"for thousands separators, write csv: {{thousands: {json.dumps(sign)}}}"
            otherwise = ""
        elif self._decimal == "," and Cells(".").is_number(stripped):
            remedy = 'if all its decimals stand behind a point, write csv: {decimal: "."}'
        return f"{place}{': ' if place else ''}{text!r} is no number: {remedy} in the channel map{otherwise}"


def grouping_of(text: str) -> str:
    """Return the sign between groups of three digits where a text looks like a number with some, else ''."""
    match = _GROUPED.fullmatch(text.strip())
    sign = match[1] if match else ""
    return " " if sign and sign in _BLANKS else sign.replace(_APOSTROPHE, "'")
