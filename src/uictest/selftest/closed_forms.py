"""Closed forms: air in a tank, friction of a caliper and of the contact, the distance of a dry stop."""

import math
from itertools import pairwise
from typing import Any, Final

import numpy as np

from uictest import rig
from uictest.core import physics
from uictest.core.recording import TIME, Recording
from uictest.plans import scenario
from uictest.selftest.known_stops import Answer, Check, KnownStops

_RATIO: Final = 1.4
"""Of the heat capacities of air."""
_GAS_CONSTANT: Final = 287.05
"""Of air, J/(kg K)."""
_WARM: Final = 293.15
"""20 degC in K."""
_VOLUME: Final = 2e-3
"""Of a tank, m3; chosen, like the numbers below: any other would do."""
_CONDUCTANCE: Final = 1e-8
"""Of an orifice, m3/(s Pa): 1 litre per second and bar."""
_LAW: Final = physics.orifice_law(critical_ratio=0.35, laminar_ratio=0.995)
_ISOTHERMAL: Final = 1e9
"""Heat conductance within a step, J/K, against which the heat capacity of the air is negligible."""


def _temperature_after(mass: float, temperature: float, gained: float, *, exchange: float = 0.0) -> float:
    """Return the temperature of a tank whose air, now `mass` kg, gained some at 20 degC, or lost some, K."""
    capacity = _GAS_CONSTANT / (_RATIO - 1.0)
    energy = physics.enthalpy(gained, _WARM, temperature, _RATIO * capacity)
    pressure = (mass - gained) * _GAS_CONSTANT * temperature / _VOLUME
    warming, _ = physics.air_changes(
        *(pressure, temperature, mass, gained, energy, _VOLUME, 0.0, _WARM, exchange),
        *(_GAS_CONSTANT, capacity),
    )
    return temperature + warming


def _blown_down_tank(stops: KnownStops) -> Answer:
    """p(t) = p0 exp(-t C rho0 R T / V) as long as the flow is choked."""
    step, count = 1e-5, 10_000
    begin = mass = 1e6 * _VOLUME / (_GAS_CONSTANT * _WARM)
    temperature = _WARM
    for _ in range(count):
        pressure = mass * _GAS_CONSTANT * temperature / _VOLUME
        lost = step * physics.mass_flow(pressure, 1e5, 1.0, 1.0, _CONDUCTANCE, *_LAW)
        mass -= lost
        temperature = _temperature_after(mass, temperature, -lost, exchange=_ISOTHERMAL)
    rate = _CONDUCTANCE * physics.REFERENCE_DENSITY * _GAS_CONSTANT * _WARM / _VOLUME
    return Answer(math.exp(-rate * step * count), mass * temperature / (begin * _WARM))


_CLEARANCE: Final = 2.9e-3
"""Of the caliper, m; chosen, like the numbers below: any other would do."""
_STROKE: Final = 3.4e-3
"""At which the width of the loop is compared, m."""
_PISTON_AREA: Final = 0.018
_PRELOAD: Final = 700.0
_SPRING: Final = 1645.0
_COULOMB: Final = 60.0
_LOAD_FRICTION: Final = 0.055
_CONTACT: Final = 8e6
_DERIVED: Final = physics.stiffnesses(_SPRING, _LOAD_FRICTION, 0.0, 0.0, _CONTACT, 5e-4)
_HALVINGS: Final = 60


def _play_loop(stops: KnownStops) -> Answer:
    """Area between two lines of the slope s, h apart, over a pressure that runs dp up and down."""
    slope, apart, highest, count = 0.1, 4e3, 4e5, 4000
    up = [highest * k / count for k in range(count + 1)]
    cycle = [*up[:-1], *reversed(up[1:])]
    forces, force = [], 0.0
    for pressure in [*cycle, *cycle]:
        force = physics.force_after(force, slope * pressure, slope * pressure + apart)
        forces.append(force)
    corners = list(zip(cycle, forces[len(cycle) :], strict=True))
    doubled = math.fsum(x1 * y2 - x2 * y1 for (x1, y1), (x2, y2) in pairwise([*corners, corners[0]]))
    return Answer(apart * highest - apart**2 / slope, abs(doubled) / 2.0)


def _caliper_loop(stops: KnownStops) -> Answer:
    """At one stroke, squeezing and releasing pressure are 2 (Fc + alpha N) / A apart."""
    load = _CONTACT * (_STROKE - _CLEARANCE)
    expected = 2.0 * (_COULOMB + _LOAD_FRICTION * load) / _PISTON_AREA
    return Answer(expected, _moving_pressure(squeezing=True) - _moving_pressure(squeezing=False))


def _moving_pressure(*, squeezing: bool) -> float:
    """Return the pressure beyond which the piston squeezes, or below which it releases, by halving, Pa."""
    low, high = 0.0, 1e6
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        stroke = physics.stroke_after(
            _STROKE, middle, _PISTON_AREA, _PRELOAD, _COULOMB, _CLEARANCE, *_DERIVED
        )
        is_beyond = stroke > _STROKE if squeezing else stroke >= _STROKE
        low, high = (low, middle) if is_beyond else (middle, high)
    return high


_WHEEL_LOAD: Final = 55e3
"""N; chosen, like the numbers below: any other would do."""
_STIFFNESS: Final = 1e7
"""Of the contact, N."""
_SPEED: Final = 20.0
"""m/s."""
_FRICTION: Final = 0.3


def _share_of_limit(gradient: float, adhesion: float, slip: float) -> float:
    """Return the creep force over the friction limit, which does not fall with the slip speed here.

    Args:
        gradient: eps of the tangential stress.
        adhesion: kA.
        slip: kS.
    """
    limit = _WHEEL_LOAD * _FRICTION
    slip_speed = gradient * limit / _STIFFNESS * _SPEED
    law = _FRICTION, 1.0, 0.0, adhesion, slip
    force, _ = physics.creep_force(slip_speed, _SPEED, _WHEEL_LOAD, _STIFFNESS, *law)
    return force / limit


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
    wheelsets = zip(vehicle.rotational_inertias, vehicle.wheel_radii, strict=True)
    turning = math.fsum(float(inertia) / radius**2 for inertia, radius in wheelsets)
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


_CHECKS: Final[tuple[tuple[Any, ...], ...]] = (
    (
        *("textbook-stop", "distance of a stop on a good rail: v0 te + v0^2/(2 a)"),
        *(_distance, _TOLERANCE, "m", "closed form of the rig's own force"),
    ),
    (
        *("adiabatic-tank", "an evacuated tank, filled without heat: k T outside"),
        lambda stops: Answer(_RATIO * _WARM, _temperature_after(0.01, _WARM, 0.01)),
        *(1e-12, "K", "closed form"),
    ),
    (
        "isothermal-tank",
        "choked blow-down at one temperature: pressure left after 0.1 s, an exponential",
        *(_blown_down_tank, 1e-5, "1", "closed form"),
    ),
    (
        *("choked-orifice", "1 l/(s bar) at 1 bar carries the density of ISO 8778"),
        lambda stops: Answer(1.185e-3, physics.mass_flow(1e5, 0.0, 1.0, 1.0, _CONDUCTANCE, *_LAW)),
        *(1e-12, "kg/s", "publication"),
    ),
    (
        *("creep-without-reduction", "creep force over Q mu at eps = 1, kA = kS = 1: 1/pi + 1/2"),
        lambda stops: Answer(1.0 / math.pi + 0.5, _share_of_limit(1.0, 1.0, 1.0)),
        *(1e-12, "1", "closed form"),
    ),
    (
        "creep-on-wet-rail",
        "the same at eps = 4.467 with the factors of a wet rail (Polach 2005): 0.573",
        lambda stops: Answer(0.573, _share_of_limit(4.467, 0.3, 0.1)),
        *(1e-3, "1", "publication"),
    ),
    (
        *("highest-creep", "the same while everything slides: the friction limit"),
        lambda stops: Answer(1.0, _share_of_limit(1e9, 1.0, 1.0)),
        *(1e-8, "1", "closed form"),
    ),
    (
        *("play-loop", "area of the closed loop of a play between two lines: h dp - h2/s"),
        *(_play_loop, 1e-9, "N Pa", "closed form"),
    ),
    (
        *("caliper-loop", "width of the caliper's loop: twice the friction over the piston area"),
        *(_caliper_loop, 1e-6, "Pa", "closed form"),
    ),
)
"""Name, what is known, both answers, tolerance, unit, origin."""
PHYSICS_CHECKS: Final = tuple(
    Check(name, "physics", what, answer, tolerance, unit, origin=origin)
    for name, what, answer, tolerance, unit, origin in _CHECKS
)
