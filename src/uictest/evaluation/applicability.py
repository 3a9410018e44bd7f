"""The conditions of a stop, and whether a criterion applies under them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from uictest import scenario
from uictest.units import in_unit, value_text


@dataclass(frozen=True, slots=True)
class TestConditions:
    """Conditions of a stop that a criterion can require.

    `command` is a share of full service, `gradient` a share, positive uphill.
    """

    rail_condition: str
    wsp: str
    position: str
    command: float
    gradient: float
    topology: str


def test_conditions_of(resolved: scenario.Scenario) -> TestConditions:
    """Return the conditions that a resolved scenario states."""
    return TestConditions(
        rail_condition=resolved.rail.condition.name,
        wsp=resolved.rig.wsp,
        position=resolved.brake.position,
        command=float(resolved.brake.command),
        gradient=float(resolved.rail.gradient),
        topology=resolved.rig.topology,
    )


def why_not_applicable(
    applies: scenario.Applicability, conditions: TestConditions, initial_speed: float | None
) -> str:
    """Return why a criterion does not apply to a stop from `initial_speed` (m/s); empty where it does.

    An initial speed that is not known (None) is no reason.
    """
    reasons = [
        _other_than("rail", conditions.rail_condition, applies.rail_condition),
        _other_than("WSP", conditions.wsp, applies.wsp),
        _other_than("brake position", conditions.position, applies.brake_position),
        _other_than("topology", conditions.topology, applies.topology),
        ""
        if initial_speed is None
        else _outside("initial speed", initial_speed, applies.initial_speed, "km/h"),
        _outside("brake command", conditions.command, applies.command, "%"),
        _outside("gradient", conditions.gradient, applies.gradient, "permille"),
    ]
    return "; ".join(reason for reason in reasons if reason)


def _other_than(what: str, value: str, accepted: Sequence[str] | None) -> str:
    if accepted is None or value in accepted:
        return ""
    return f"{what} is {value}, the criterion is for {' or '.join(accepted)}"


def _outside(what: str, value: float, accepted: scenario.Nominal | None, unit: str) -> str:
    if accepted is None or _within(value, accepted):
        return ""
    shown, nominal, tolerance = (
        in_unit(number, unit) for number in (value, accepted.value, accepted.tolerance)
    )
    return (
        f"{what} is {value_text(shown, unit)}, the criterion is for {nominal:.4g} +-"
        f" {value_text(tolerance, unit)}"
    )


def _within(value: float, accepted: scenario.Nominal) -> bool:
    # Written so that NaN is not within; the last digits belong to unit conversion, not to the stop.
    return abs(value - accepted.value) <= accepted.tolerance * (1.0 + 1e-9)
