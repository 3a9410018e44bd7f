"""What physics allows: a stop that no brake can beat, a brake force that no rail can carry."""

import math

from uictest.scenario.parts.brake import Disc
from uictest.scenario.parts.caliper import Caliper
from uictest.scenario.parts.compensation import Compensation
from uictest.scenario.parts.criteria import WHEELSETS
from uictest.scenario.parts.vehicle import Vehicle
from uictest.units import STANDARD_GRAVITY


def stopping_time_at_least(speed: float, friction: float, gradient: float, vehicle: Vehicle) -> float:
    """Seconds below which no stop from ``speed`` (m/s) can end, infinite when the car never stops.

    Friction, gradient and the running resistance at the initial speed act in full until the end.
    """
    resistance = vehicle.running_resistance
    drag = resistance.constant + resistance.linear * speed + resistance.quadratic * speed**2
    deceleration = STANDARD_GRAVITY * (friction + gradient) + drag / vehicle.total_mass
    return speed / deceleration if deceleration > 0.0 else math.inf


def largest_clamping_force(caliper: Caliper, compensation: Compensation, pressure: float) -> float:
    """The larger of the forces, N, that caliper and compensation give at a gauge pressure in Pa."""
    lines = (compensation.linear, compensation.hysteresis.bc_releasing, compensation.hysteresis.wsp_releasing)
    net = max(0.0, caliper.piston_area * pressure - caliper.preload)
    return max(caliper.lever_ratio * net, *(line.force(pressure) for line in lines))


def braking_force(disc: Disc, vehicle: Vehicle, clamping_force: float) -> float:
    """Force at the rims of all wheelsets, N, when every caliper clamps with ``clamping_force`` N."""
    faces = WHEELSETS * disc.calipers_per_wheelset * disc.pads_per_caliper
    return faces * disc.pad_friction * clamping_force * disc.mean_radius / vehicle.wheelset.radius
