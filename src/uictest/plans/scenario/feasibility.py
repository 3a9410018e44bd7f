"""Limits of physics: the shortest stop and the largest brake force."""

import math
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import Final, NamedTuple

from uictest.core import physics
from uictest.core.units import STANDARD_GRAVITY
from uictest.plans.scenario.files import Files
from uictest.plans.scenario.parts.brake import Disc
from uictest.plans.scenario.parts.caliper import Caliper
from uictest.plans.scenario.parts.compensation import Compensation
from uictest.plans.scenario.parts.criteria import Criteria
from uictest.plans.scenario.parts.vehicle import Vehicle
from uictest.plans.scenario.references import Parts
from uictest.plans.scenario.total import total
from uictest.plans.scenario.yaml import Document, Place, Scalar


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
