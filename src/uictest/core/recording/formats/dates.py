"""Times that a file writes as dates, as a date and a clock in two columns, or as a clock alone."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Sequence
from itertools import product
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.core.recording.formats.file_formats import UnreadableError

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
    stamps = _stamps(stripped, written or "ISO8601")
    if (unread := filled & stamps.isna()).any():
        raise UnreadableError(
            _advice(list(map(str, stripped[filled])), str(stripped[unread].iloc[0]), written)
        )
    if not is_clock(written):
        return _since(stamps, pd.Timestamp(0, tz="UTC"))
    return over_midnight(_since(stamps, pd.Timestamp("1900-01-01", tz="UTC")))


def is_clock(written: str) -> bool:
    """Return whether a way of writing has a time of the day and no date."""
    return bool(written) and not any(directive in written for directive in _DAY_DIRECTIVES)


def over_midnight(clock: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return times of the day, s, that go on where they begin anew at midnight."""
    passed = np.nan_to_num(np.diff(clock, prepend=clock[:1])) < -_HALF_A_DAY
    return clock + DAY * np.cumsum(passed)


def _stamps(texts: Any, written: str) -> Any:
    """Return time stamps; a fraction of a second may be left out where it is none."""
    import pandas as pd

    stamps = pd.to_datetime(texts, format=written, errors="coerce", utc=True)
    if (whole := _FRACTION.sub("", written)) != written and stamps.isna().any():
        stamps = stamps.fillna(pd.to_datetime(texts, format=whole, errors="coerce", utc=True))
    return stamps


def _since(stamps: Any, origin: Any) -> NDArray[np.float64]:
    return np.asarray((stamps - origin).dt.total_seconds(), dtype=np.float64)


def are_dates(samples: NDArray[Any]) -> bool:
    """Return whether samples are texts of dates as ISO 8601 writes them, by the first that is not empty."""
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
        if len(sampled) and _stamps(sampled[:1], way).notna().all() and _stamps(sampled, way).notna().all():
            yield way


def _advice(texts: Sequence[str], wrong: str, written: str) -> str:
    way = next(written_as(texts), "")
    if written and not way:
        return f"{wrong!r} is not written as csv: {{dates: {json.dumps(written)}}} says"
    if way:
        return f"{wrong!r} is a date or a clock: write csv: {{dates: {json.dumps(way)}}} in the channel map"
    return (
        f"{wrong!r} is no date as 2026-05-31T12:00:00.000: write in the channel map how dates are written,"
        ' as in csv: {dates: "%d.%m.%Y %H:%M:%S.%f"}'
    )
