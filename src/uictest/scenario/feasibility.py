"""Limits of physics and of the integration: the shortest stop, the largest brake force, the longest step."""

import math

from uictest import physics
from uictest.scenario.parts.brake import Disc
from uictest.scenario.parts.caliper import Caliper
from uictest.scenario.parts.compensation import Compensation
from uictest.scenario.parts.criteria import WHEELSET_COUNT
from uictest.scenario.parts.vehicle import Vehicle
from uictest.units import STANDARD_GRAVITY

_PRIMARIES, _SECONDARIES = 2.0, 2.0
"""Axle boxes of a wheelset, sides of a bogie."""


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


def braking_force(disc: Disc, vehicle: Vehicle, clamping_force: float) -> float:
    """Return the force at the rims of all wheelsets, N, with ``clamping_force`` N at every caliper."""
    torque = physics.torque(
        clamping_force,
        disc.calipers_per_wheelset,
        disc.pads_per_caliper,
        disc.pad_friction,
        disc.mean_radius,
    )
    return WHEELSET_COUNT * torque / vehicle.wheelset.radius


def longest_step(vehicle: Vehicle) -> tuple[float, str]:
    """Return the longest stable step, s, and the motion that limits it.

    Semi-implicit Euler with explicit damping keeps a motion of mass m, stiffness k and damping c bounded
    while k h2 + 2 c h < 4 m. Coupled to others a motion is at most twice as stiff (Gershgorin), so that
    k h2 + 2 c h <= 2 m is demanded of each.
    """
    return min((_stable_step(mass, *coupling), name) for name, mass, coupling in _motions(vehicle))


def _stable_step(mass: float, stiffness: float, damping: float) -> float:
    return (math.sqrt(damping**2 + 2.0 * stiffness * mass) - damping) / stiffness


_Coupling = tuple[float, float]
"""Stiffness and damping."""


def _motions(vehicle: Vehicle) -> list[tuple[str, float, _Coupling]]:
    body, bogie, wheelset = vehicle.body, vehicle.bogie, vehicle.wheelset
    primary, secondary, link = vehicle.primary, vehicle.secondary, vehicle.traction_link
    pull = (_PRIMARIES * primary.longitudinal_stiffness, _PRIMARIES * primary.longitudinal_damping)
    lift = (_PRIMARIES * primary.vertical_stiffness, _PRIMARIES * primary.vertical_damping)
    side_pull = (
        _SECONDARIES * secondary.longitudinal_stiffness,
        _SECONDARIES * secondary.longitudinal_damping,
    )
    side_lift = (_SECONDARIES * secondary.vertical_stiffness, _SECONDARIES * secondary.vertical_damping)
    rod = (float(link.stiffness), float(link.damping))

    def pitch(height: float) -> list[tuple[float, _Coupling]]:
        return [((secondary.height - height) ** 2, side_pull), ((link.height - height) ** 2, rod)]

    on_axles = (bogie.height - wheelset.radius) ** 2
    return [
        ("a wheelset on its primary suspension", float(wheelset.mass), pull),
        ("the longitudinal motion", float(bogie.mass), _sum((2.0, pull), (1.0, side_pull), (1.0, rod))),
        ("the bounce of a bogie", float(bogie.mass), _sum((2.0, lift), (1.0, side_lift))),
        (
            "the pitch of a bogie",
            float(bogie.pitch_inertia),
            _sum((2.0 * on_axles, pull), (2.0 * bogie.half_wheelbase**2, lift), *pitch(bogie.height)),
        ),
        ("the longitudinal motion", float(body.mass), _sum((2.0, side_pull), (2.0, rod))),
        ("the bounce of the body", float(body.mass), _sum((2.0, side_lift))),
        (
            "the pitch of the body",
            float(body.pitch_inertia),
            _sum((2.0 * vehicle.half_pivot_distance**2, side_lift), *pitch(body.height), *pitch(body.height)),
        ),
    ]


def _sum(*parts: tuple[float, _Coupling]) -> _Coupling:
    return sum(share * k for share, (k, _) in parts), sum(share * c for share, (_, c) in parts)
