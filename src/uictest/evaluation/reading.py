"""What a measure gives for one stop: a value, one value per wheelset, or the reason why there is none."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Reading:
    """SI values of a measure, one for the stop or one per wheelset.

    `missing` says why the record cannot support the measure; empty where it can. `at_least` marks the value
    of a stop that was still going on: the full value would be larger. `remark` says more about a value than
    its number does.
    """

    values: tuple[float, ...] = ()
    missing: str = ""
    at_least: bool = False
    remark: str = ""


def value(number: float) -> Reading:
    """Return the reading of one value for the stop."""
    return Reading((float(number),))


def unsupported(why: str) -> Reading:
    """Return a reading without a value, and why."""
    return Reading(missing=why)
