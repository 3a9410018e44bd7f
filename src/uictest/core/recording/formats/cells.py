"""Cells of a text table: numbers as its dialect writes them, missing samples, texts, dates and clocks."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Sequence
from itertools import product
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.core.recording.formats.file_formats import UnreadableError

MISSING: Final = (
    *("", "-", "nan", "NaN", "NAN", "-nan", "-NaN", "NA", "N/A", "n/a", "#N/A", "#NA", "<NA>", "#N/A N/A"),
    *("NULL", "null", "None", "1.#IND", "-1.#IND", "1.#QNAN", "-1.#QNAN"),
)
"""What every table may write for a sample that is missing; its dialect may add others."""
LONGEST_TEXT: Final = 64
"""Characters of a text that are kept; chosen."""
MOST_LOCATED: Final = 20
"""Different texts of a channel of which it is kept where they first stand; chosen."""
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
        return {text: row for row, text in in_order[:MOST_LOCATED] if text}


def joined(columns: Sequence[TextColumn]) -> TextColumn:
    """Return the parts of a column as one."""
    numbers = np.concatenate([column.numbers for column in columns])
    if all(column.texts is None for column in columns):
        return TextColumn(numbers, None)
    parts = [np.zeros(len(part.numbers), "U1") if part.texts is None else part.texts for part in columns]
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

    def refusal(self, text: str, location: str = "") -> str:
        """Return the message for a cell that is not a number, with the remedy in the channel map."""
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
        where = f"{location}: " if location else ""
        return f"{where}{text!r} is no number: {remedy} in the channel map{otherwise}"


def grouping_of(text: str) -> str:
    """Return the sign between groups of three digits where a text looks like a number with some, else ''."""
    match = _GROUPED.fullmatch(text.strip())
    sign = match[1] if match else ""
    return " " if sign and sign in _BLANKS else sign.replace(_APOSTROPHE, "'")


_ISO: Final = re.compile(r"\d{4}-\d\d-\d\d[T ]\d\d:\d\d(?::\d\d.*)?")
_DAYS: Final = ("%d.%m.%Y", "%d/%m/%Y", "%d-%m-%Y", "%m/%d/%Y", "%m-%d-%Y", "%Y/%m/%d", "%Y-%m-%d")
_SHORT_DAYS: Final = ("%d.%m.%y", "%d/%m/%y", "%m/%d/%y", "%Y%m%d", "%d-%b-%Y", "%d %b %Y", "%b %d %Y")
_CLOCKS: Final = ("%H:%M:%S.%f", "%H:%M:%S,%f", "%H:%M:%S:%f", "%H:%M", "%I:%M:%S.%f %p", "%I:%M:%S,%f %p")
"""Usual ways of writing a date and the time of a day, of which one is proposed; day first, where both fit."""
_FRACTION: Final = re.compile(r"[.,:;]?%f")
_DAY_DIRECTIVES: Final = ("%d", "%j", "%Y", "%y", "%c", "%x")
DAY: Final = 86_400.0
_HALF_A_DAY: Final = 0.5 * DAY
"""s that a clock alone must go back to have passed midnight; chosen."""
_SAMPLED: Final = 200
"""Cells by which a way of writing is proposed; chosen."""


def seconds_of(texts: NDArray[Any], written: str) -> NDArray[np.float64]:
    """Return times as Unix time, a clock without a date as time since its first midnight, both in s.

    Args:
        texts: of dates or clocks, one a sample; an empty one is missing and becomes NaN.
        written: how, in the directives of C's strftime; empty: as ISO 8601.

    Raises UnreadableError that shows the first text written otherwise and what to write in a channel map.
    """
    import pandas as pd

    stripped = pd.Series(np.char.strip(texts))
    filled = stripped != ""
    stamps = _time_stamps(stripped, written or "ISO8601")
    if (unread := filled & stamps.isna()).any():
        raise UnreadableError(
            _date_advice(list(map(str, stripped[filled])), str(stripped[unread].iloc[0]), written)
        )
    if not is_clock(written):
        return _seconds_since(stamps, pd.Timestamp(0, tz="UTC"))
    return over_midnight(_seconds_since(stamps, pd.Timestamp("1900-01-01", tz="UTC")))


def is_clock(written: str) -> bool:
    """Return whether a format has a time of the day and no date."""
    return bool(written) and not any(directive in written for directive in _DAY_DIRECTIVES)


def over_midnight(clock: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return times of the day, s, that continue past midnight instead of starting at zero."""
    passed = np.nan_to_num(np.diff(clock, prepend=clock[:1])) < -_HALF_A_DAY
    return clock + DAY * np.cumsum(passed)


def _time_stamps(texts: Any, written: str) -> Any:
    """Return time stamps; a fraction of zero seconds may be left out of the text."""
    import pandas as pd

    stamps = pd.to_datetime(texts, format=written, errors="coerce", utc=True)
    if (whole := _FRACTION.sub("", written)) != written and stamps.isna().any():
        stamps = stamps.fillna(pd.to_datetime(texts, format=whole, errors="coerce", utc=True))
    return stamps


def _seconds_since(stamps: Any, origin: Any) -> NDArray[np.float64]:
    return np.asarray((stamps - origin).dt.total_seconds(), dtype=np.float64)


def are_dates(samples: NDArray[Any]) -> bool:
    """Return whether the first text of samples that is not empty is a date of ISO 8601."""
    if samples.dtype.kind != "U":
        return False
    first = next((text for text in samples[:_SAMPLED].tolist() if text.strip()), "")
    return _ISO.fullmatch(first.strip()) is not None


def written_as(texts: Sequence[str]) -> Iterator[str]:
    """Yield the usual ways in which texts may be written, the likeliest first."""
    import pandas as pd

    sampled = pd.Series([text.strip() for text in texts if text.strip()][:_SAMPLED], dtype=object)
    days = ("".join(pair) for pair in product((*_DAYS, *_SHORT_DAYS), (" ", "T", "_")))
    for way in map("".join, product((*days, ""), _CLOCKS)):
        # Most ways are ruled out by the first text.
        if (
            len(sampled)
            and _time_stamps(sampled[:1], way).notna().all()
            and _time_stamps(sampled, way).notna().all()
        ):
            yield way


def _date_advice(texts: Sequence[str], wrong: str, written: str) -> str:
    way = next(written_as(texts), "")
    if written and not way:
        return f"{wrong!r} is not written as csv: {{dates: {json.dumps(written)}}} says"
    if way:
        return f"{wrong!r} is a date or a clock: write csv: {{dates: {json.dumps(way)}}} in the channel map"
    return (
        f"{wrong!r} is no date as 2026-05-31T12:00:00.000: write in the channel map how dates are written,"
        ' as in csv: {dates: "%d.%m.%Y %H:%M:%S.%f"}'
    )
