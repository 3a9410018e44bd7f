"""Whether a criterion has anything to say about a stop, and if not, why."""

from __future__ import annotations

from collections.abc import Sequence

from uictest import scenario
from uictest.evaluation.conditions import TestConditions
from uictest.units import in_unit, value_text


def why_not_applicable(
    applies: scenario.Applicability, stop: TestConditions, initial_speed: float | None
) -> str:
    """Return why a criterion does not apply to a stop from `initial_speed` (m/s); empty where it does.

    An initial speed that is not known (None) is no reason.
    """
    reasons = [
        _other_than("rail", stop.rail_condition, applies.rail_condition),
        _other_than("WSP", stop.wsp, applies.wsp),
        _other_than("brake position", stop.position, applies.brake_position),
        _other_than("topology", stop.topology, applies.topology),
        ""
        if initial_speed is None
        else _outside("initial speed", initial_speed, applies.initial_speed, "km/h"),
        _outside("brake command", stop.command, applies.command, "%"),
        _outside("gradient", stop.gradient, applies.gradient, "permille"),
    ]
    return "; ".join(reason for reason in reasons if reason)


def _other_than(what: str, found: str, wanted: Sequence[str] | None) -> str:
    if wanted is None or found in wanted:
        return ""
    return f"{what} is {found}, the criterion is for {' or '.join(wanted)}"


def _outside(what: str, found: float, wanted: scenario.Nominal | None, unit: str) -> str:
    if wanted is None or _within(found, wanted):
        return ""
    is_, nominal, tolerance = (in_unit(number, unit) for number in (found, wanted.value, wanted.tolerance))
    return (
        f"{what} is {value_text(is_, unit)}, the criterion is for {nominal:.4g}"
        f" +- {value_text(tolerance, unit)}"
    )


def _within(found: float, wanted: scenario.Nominal) -> bool:
    # Written so that NaN is not within; the last digits belong to unit conversion, not to the stop.
    return abs(found - wanted.value) <= wanted.tolerance * (1.0 + 1e-9)
