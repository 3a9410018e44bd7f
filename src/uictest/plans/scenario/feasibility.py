"""What no stop can do: brakes without grip, stops without end, faults and pole wheels that cannot be."""

import math
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path
from typing import Any, Final, NamedTuple

from uictest.core import physics
from uictest.core.units import STANDARD_GRAVITY
from uictest.plans.scenario.files import Files
from uictest.plans.scenario.parts.brake import Caliper, Disc
from uictest.plans.scenario.parts.compensation import Compensation
from uictest.plans.scenario.parts.criteria import Criteria
from uictest.plans.scenario.parts.fault import SPEED
from uictest.plans.scenario.parts.vehicle import Vehicle
from uictest.plans.scenario.parts.wheelsets import WHEELSET_NUMBERS, deciding_key, wheelset_value
from uictest.plans.scenario.references import Parts
from uictest.plans.scenario.yaml import Document, Inconsistency, Model, Place, Scalar, total


class BrakedWheelset(NamedTuple):
    """What of a wheelset decides its brake force: a share, a coefficient and a radius in m."""

    brake_force: float
    pad_friction: float
    wheel_radius: float


def stopping_time_at_least(speed: float, friction: float, gradient: float, vehicle: Vehicle) -> float:
    """Return the shortest time, s, of a stop from ``speed`` (m/s); infinite if the car never stops.

    Friction, gradient and the running resistance at the initial speed act in full until the end.
    """
    resistance = vehicle.running_resistance
    drag = resistance.constant + resistance.linear * speed + resistance.quadratic * speed**2
    deceleration = STANDARD_GRAVITY * (friction + gradient) + drag / vehicle.total_mass
    return speed / deceleration if deceleration > 0.0 else math.inf


def largest_clamping_force(caliper: Caliper, compensation: Compensation, pressure: float) -> float:
    """Return the larger force, N, of caliper and compensation at a gauge pressure in Pa."""
    lines = (compensation.linear, compensation.hysteresis.bc_releasing, compensation.hysteresis.wsp_releasing)
    net = max(0.0, caliper.piston_area * pressure - caliper.preload)
    return max(caliper.lever_ratio * net, *(line.force(pressure) for line in lines))


def braking_force(disc: Disc, wheelsets: Iterable[BrakedWheelset], clamping_force: float) -> float:
    """Return the force at the rims of all wheelsets, N, with ``clamping_force`` N at every caliper."""
    calipers, pads, radius = disc.calipers_per_wheelset, disc.pads_per_caliper, disc.mean_radius
    return total(
        each.brake_force
        * physics.torque(clamping_force, calipers, pads, each.pad_friction, radius)
        / each.wheel_radius
        for each in wheelsets
    )


RIG_CHECKS: Final = "uictest-rig"
"""Name of the profile."""


@cache
def rig_checks() -> Criteria:
    """Return the profile."""
    place = Place(Document(RIG_CHECKS, Path(), RIG_CHECKS))
    profile: Criteria = Parts(Files()).resolve(Scalar(RIG_CHECKS, RIG_CHECKS, place), Criteria, ()).part
    return profile


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
