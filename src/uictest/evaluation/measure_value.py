"""What a measure gives for one stop: a value, one value per wheelset, or the reason why there is none."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class MeasureValue:
    """SI values of a measure, one for the stop or one per wheelset, as far as the stop was observed.

    `missing` says why there is no value; empty where there is one.
    """

    values: tuple[float, ...] = ()
    missing: str = ""


def value(number: float) -> MeasureValue:
    """Return the reading of one value for the stop."""
    return MeasureValue((float(number),))


def unsupported(why: str) -> MeasureValue:
    """Return a reading without a value, and why."""
    return MeasureValue(missing=why)
