"""Differences as the page shows them: titles instead of names, and the units of every page."""

from __future__ import annotations

import dataclasses

from uictest.core.measures import WHEELSET_COLUMNS
from uictest.core.units import SIZES
from uictest.report import Difference, Value, channel_title, sheet_column, shown_unit


def quantity_title(difference: Difference) -> str:
    """Return what a quantity is called; a name that is no measure of a case and no channel stays."""
    if not difference.case:
        return channel_title(difference.quantity)
    measure, wheelset = _without_wheelset(difference.quantity)
    heading = sheet_column(measure).heading
    if heading == difference.quantity:
        return heading
    title = heading.capitalize()
    return f"{title} of wheelset {wheelset}" if wheelset else title


def in_page_units(difference: Difference) -> Difference:
    """Return a difference of measures in the units of every page: kN, and shares in %."""
    measure, _ = _without_wheelset(difference.quantity)
    own = sheet_column(measure).unit if difference.case else ""
    unit = shown_unit(measure, own or difference.unit)
    if unit == difference.unit or not {unit, difference.unit} <= SIZES.keys():
        return difference
    size = SIZES[unit] / SIZES[difference.unit]
    return dataclasses.replace(
        difference,
        unit=unit,
        first=_scaled(difference.first, size),
        second=_scaled(difference.second, size),
        deviation=None if difference.deviation is None else difference.deviation / size,
        allowed=None if difference.allowed is None else difference.allowed / size,
    )


def _scaled(value: Value, size: float) -> Value:
    return value if isinstance(value, str) else value / size


def _without_wheelset(quantity: str) -> tuple[str, str]:
    """Return the measure of a quantity and the number of its wheelset, empty where it has none."""
    measure, _, wheelset = quantity.rpartition("_")
    return (measure, wheelset) if measure in WHEELSET_COLUMNS and wheelset.isdigit() else (quantity, "")
