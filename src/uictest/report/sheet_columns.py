"""Columns of a workbook: heading, unit and number format, from the name of the column in the tables."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from uictest.core.measures import STOP_COLUMNS, WHEELSET_COLUMNS

_BY_UNIT: Final = {
    "m": "0.0",
    "s": "0.00",
    "m/s2": "0.000",
    "g": "0.0000",
    "bar": "0.00",
    "NL": "0",
    "kJ": "0.0",
    "N": "0",
    "degC": "0",
}
"""Unit -> number format: the digits that a brake engineer compares, the cell holds them all."""

_OWN: Final = {
    "narrowest_margin": ("%", "0.0 %"),
    "narrowest_criterion": ("", ""),
    "share": ("%", "0 %"),
    "share_low": ("%", "0 %"),
    "share_high": ("%", "0 %"),
    "share_met": ("%", "0 %"),
}
"""Column that is no measure -> unit and number format."""

_COUNT, _SHARE, _RESIDUAL = "0", "0.0 %", "0.0E+00"
NUMBER_FORMATS: Final = frozenset(
    {*_BY_UNIT.values(), *(own for _, own in _OWN.values()), _COUNT, _SHARE, _RESIDUAL} - {""}
)
"""Every number format that a column can have."""

_ENDS: Final = ("_lowest", "_highest")


@dataclass(frozen=True, slots=True)
class SheetColumn:
    """How a column is shown; `unit` and `number_format` are empty where it has none of its own."""

    heading: str
    unit: str = ""
    number_format: str = ""


def sheet_column(name: str) -> SheetColumn:
    """Return how a column of the tables is shown: a measure in words with its unit, others under their name.

    A range of repeats (`..._lowest`) and the number of a wheelset (`..._3`) may follow the name of a measure.
    """
    measure, end = _without_end(name)
    column = STOP_COLUMNS.get(measure) or WHEELSET_COLUMNS.get(measure)
    if column is None:
        return SheetColumn(name.replace("_", " "), *_OWN[name]) if name in _OWN else SheetColumn(name)
    words = f"{measure.removesuffix(_suffix(column.unit))}{end}".replace("_", " ")
    return SheetColumn(words, *_unit_and_format(measure, column.unit, whole=column.whole))


def _without_end(name: str) -> tuple[str, str]:
    """Return a name without what may follow a measure, and that."""
    stem, _, last = name.rpartition("_")
    if name in STOP_COLUMNS or name in WHEELSET_COLUMNS or not stem:
        return name, ""
    return (stem, f"_{last}") if last.isdigit() or f"_{last}" in _ENDS else (name, "")


def _suffix(unit: str) -> str:
    """Return the end of the names of columns in a unit, e.g. `_mps2` of m/s2."""
    return f"_{unit.lower().replace('/', 'p')}"


def _unit_and_format(measure: str, unit: str, *, whole: bool) -> tuple[str, str]:
    if unit != "1":
        return unit, _BY_UNIT.get(unit, "")
    if measure.endswith("_residual"):
        return "", _RESIDUAL
    return ("", _COUNT) if whole else ("%", _SHARE)
