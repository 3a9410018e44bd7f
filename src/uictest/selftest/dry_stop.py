"""Known answers of a whole stop: s = v0 te + v0^2 / (2 a) where every wheelset rolls and nothing else brakes.

The equivalent build-up time te comes from the recorded clamping forces; the closed form is of a body of
constant mass under that force.
"""

import math
from typing import Any, Final

import numpy as np

from uictest import rig
from uictest.core.recording import TIME, Recording
from uictest.plans import scenario
from uictest.selftest.check import Answer, Check
from uictest.selftest.known_stops import KnownStops

_STOP: Final = "rolling-120"
_TOLERANCE: Final = 2e-3
"""The body pitches and the wheels creep, which the closed form leaves out."""


def dry_stop_distance(force: Any, time: Any, speed: float, mass: float) -> float:
    """Return the distance of a stop in m: of a body under a force that builds up and then stays.

    Args:
        force: at each time, N.
        time: since the brake command, s.
        speed: at first, m/s.
        mass: with what turns, kg.
    """
    missing = 1.0 - force / force[-1]
    build_up = np.trapezoid(missing, time)
    deceleration = force[-1] / mass
    # The area of the build-up decides; how it is spread changes the distance in second order.
    spread = np.trapezoid(time * missing, time) - build_up**2 / 2.0
    return float(speed * build_up + speed**2 / (2.0 * deceleration) - deceleration * spread)


def _distance(stops: KnownStops) -> Answer:
    case = stops.cases[_STOP]
    recording = rig.simulate(case, record_every=1e-3).recording
    assert recording is not None
    vehicle = case.scenario.vehicle
    turning = math.fsum(
        float(vehicle.wheelset.rotational_inertia) / radius**2 for radius in vehicle.wheel_radii
    )
    inputs = float(case.scenario.initial_speed), vehicle.total_mass + turning
    expected = dry_stop_distance(_brake_force(case, recording), recording[TIME], *inputs)
    return Answer(expected, float(stops.stop(_STOP).measures.braking_distance))


def _brake_force(case: scenario.Case, recording: Recording) -> Any:
    """Return the force of all brakes at the rims in N, from what the calipers clamp with."""
    p = rig.assemble(case)
    factors = p.wheelset_parameters["reference_pad_friction"] / p.wheelset_parameters["wheel_radius"]
    clamped = np.array([recording[f"clamping_force_{number}"] for number in range(1, 5)])
    faces = p.parameters.calipers_per_wheelset * p.parameters.pads_per_caliper
    return faces * p.parameters.disc_radius * (factors @ clamped)


DRY_STOP_CHECKS: Final = (
    Check(
        "textbook-stop",
        "physics",
        "distance of a stop on a good rail: v0 te + v0^2/(2 a)",
        *(_distance, _TOLERANCE, "m"),
    ),
)
