"""The longest step with which the car on its springs and dampers can be simulated."""

import math

from uictest.scenario.parts.vehicle import Vehicle

_PRIMARIES, _SECONDARIES = 2.0, 2.0
"""Axle boxes of a wheelset, sides of a bogie."""


def longest_step(vehicle: Vehicle) -> tuple[float, str]:
    """Longest stable step in s, and the motion that limits it.

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
