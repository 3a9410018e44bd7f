"""Faults and speed sensors that a stop cannot have, and the leaks among the faults."""

import math
from collections.abc import Iterator
from typing import Any

from uictest.plans.scenario.parts.fault import SPEED
from uictest.plans.scenario.wheelset_values import WHEELSET_NUMBERS, deciding_key, wheelset_value
from uictest.plans.scenario.yaml import Inconsistency, Model


def impossible_faults(scenario: Any) -> Iterator[Inconsistency]:
    """Yield faults that do not fit the stop of a scenario."""
    for place, fault in enumerate(scenario.faults):
        if fault.at.unit == SPEED and fault.at > scenario.initial_speed:
            yield Inconsistency(
                ("faults", place, "at"),
                f"the train never runs at {fault.at.text}: it begins to brake at"
                f" {scenario.initial_speed.text}",
                "write a lower speed, or `at: 0 s` for a fault throughout the stop",
            )
        if fault.wheelset is not None and fault.effects.lost_teeth > 0.0:
            yield from _without_teeth(scenario, place, fault)


def _without_teeth(scenario: Any, place: int, fault: Any) -> Iterator[Inconsistency]:
    """Yield a pole wheel that loses teeth though none are counted, or more teeth than it has."""
    method, teeth, missing = (
        wheelset_value(scenario, fault.wheelset, f"sensors.speed.{name}")
        for name in ("method", "teeth", "missing_teeth")
    )
    if method != "whole-teeth":
        yield Inconsistency(
            ("faults", place, "kind"),
            f"the speed sensor of wheelset {fault.wheelset} counts no teeth",
            "write `rig.sensors.speed.method: whole-teeth`",
        )
    elif missing + fault.effects.lost_teeth >= teeth:
        yield Inconsistency(
            ("faults", place, "value"),
            f"{fault.value.text} and {missing.text} of {teeth.text} teeth: at least one must be left",
        )


def tank_leak(scenario: Any, number: int) -> float:
    """Return the conductance of all leaks of the tank of a wheelset, 1 to 4, m3/(s Pa)."""
    return math.fsum(fault.effects.tank_leak for fault in scenario.faults if fault.wheelset == number)


def line_leak(scenario: Any) -> float:
    """Return the conductance of all leaks of the brake line, m3/(s Pa)."""
    return math.fsum(fault.effects.line_leak for fault in scenario.faults)


def impossible_pole_wheels(scenario: Model) -> Iterator[Inconsistency]:
    """Yield settings of the speed sensors that no pole wheel can have, for every wheelset."""
    for number in WHEELSET_NUMBERS:
        yield from _of_wheelset(scenario, number)


def _of_wheelset(scenario: Model, number: int) -> Iterator[Inconsistency]:
    names = [f"sensors.speed.{name}" for name in ("missing_teeth", "teeth", "method")]
    missing, teeth, method = (wheelset_value(scenario, number, name) for name in names)
    if missing >= teeth:
        yield Inconsistency(
            deciding_key(scenario, number, *names[:2]),
            f"{missing.text} of {teeth.text} teeth: at least one must be left",
        )
    elif missing > 0 and method == "momentary":
        yield Inconsistency(
            deciding_key(scenario, number, names[0], names[2]),
            f"a momentary speed counts no teeth, and wheelset {number} has {missing.text} missing",
            "write method: whole-teeth, or missing_teeth: 0",
        )
