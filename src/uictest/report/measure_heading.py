"""What a column of measures is called for people, and its unit."""

from __future__ import annotations

from typing import NamedTuple

from uictest.core.measures import STOP_COLUMNS, WHEELSET_COLUMNS, without_wheelset


class MeasureHeading(NamedTuple):
    """The name of a column in words and its unit, empty where it has none of its own."""

    words: str
    unit: str = ""


def measure_heading(name: str) -> MeasureHeading:
    """Return how a column is shown: a measure in words with its unit, others under their name.

    The number of a wheelset (`..._3`) may follow the name of a measure.
    """
    measure, wheelset = without_wheelset(name)
    column = STOP_COLUMNS.get(measure) or WHEELSET_COLUMNS.get(measure)
    if column is None:
        return MeasureHeading(name)
    in_unit = f"_{column.unit.lower().replace('/', 'p')}"
    words = f"{measure.removesuffix(in_unit)} {wheelset}".rstrip().replace("_", " ")
    pure = "" if column.whole or measure.endswith("_residual") else "%"
    return MeasureHeading(words, pure if column.unit == "1" else column.unit)
