"""What the brakes of a car can give, whatever the rail carries."""

from functools import partial
from typing import Any

from uictest.core import physics
from uictest.core.units import STANDARD_GRAVITY
from uictest.plans.scenario.parts.brake import Caliper
from uictest.plans.scenario.parts.compensation import Compensation
from uictest.plans.scenario.parts.vehicle import Vehicle
from uictest.plans.scenario.parts.wheelsets import WHEELSET_NUMBERS, wheelset_value
from uictest.plans.scenario.yaml import total


def largest_clamping_force(caliper: Caliper, compensation: Compensation, pressure: float) -> float:
    """Return the larger force, N, of caliper and compensation at a gauge pressure in Pa."""
    lines = (compensation.linear, compensation.hysteresis.bc_releasing, compensation.hysteresis.wsp_releasing)
    net = max(0.0, caliper.piston_area * pressure - caliper.preload)
    return max(caliper.lever_ratio * net, *(line.force(pressure) for line in lines))


def braking_forces(scenario: Any, clamping_force: float) -> list[Any]:
    """Return the force at the rims of each wheelset, N, by a clamping force, N, of every caliper."""
    disc, own = scenario.brake.system.disc, partial(wheelset_value, scenario)
    calipers, pads, radius = disc.calipers_per_wheelset, disc.pads_per_caliper, disc.mean_radius
    return [
        own(number, "brake_force")
        * physics.torque(clamping_force, calipers, pads, own(number, "pad_friction"), radius)
        / own(number, "wheel_radius")
        for number in WHEELSET_NUMBERS
    ]


def largest_braking_force(scenario: Any, clamping_force: float) -> Any:
    """Return the force at the rims of the car, N, at the best of the pads."""
    return scenario.brake.pad.largest_factor * total(braking_forces(scenario, clamping_force))


def mass_with_rotation(vehicle: Vehicle) -> float:
    """Return the mass of a car and of what of it rotates, at the rims, kg."""
    wheels = zip(vehicle.rotational_inertias, vehicle.wheel_radii, strict=True)
    return vehicle.total_mass + total(inertia / radius**2 for inertia, radius in wheels)


def running_resistance(vehicle: Vehicle, speed: float) -> float:
    """Return the running resistance of a car, N, at a speed in m/s."""
    own = vehicle.running_resistance
    return own.constant + own.linear * speed + own.quadratic * speed**2


def brake_deceleration(scenario: Any) -> float:
    """Return by how much, m/s2, its brakes slow the car of a scenario where the rail carries all of it.

    The highest commanded pressure applies the calipers against their friction; the track brake, the running
    resistance at the initial speed and the gradient act as well. A blended dynamic brake takes over from the
    friction brake and adds nothing.
    """
    vehicle, track = scenario.vehicle, scenario.brake.track
    clamping = scenario.rig.caliper.squeezing_force(scenario.highest_pressure)
    force = largest_braking_force(scenario, clamping)
    force += running_resistance(vehicle, scenario.initial_speed) + (track.largest_force if track else 0.0)
    weight = STANDARD_GRAVITY * vehicle.total_mass
    return float((force + weight * scenario.rail.gradient) / mass_with_rotation(vehicle))
