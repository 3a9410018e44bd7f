"""Longest step with which the integration follows the car on its springs and the air behind its valves."""

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from uictest.core.physics import REFERENCE_DENSITY, orifice_law
from uictest.plans.scenario.parts.brake import BrakeSystem, Caliper
from uictest.plans.scenario.parts.vehicle import Vehicle
from uictest.plans.scenario.yaml import total

_PRIMARIES, _SECONDARIES = 2.0, 2.0
"""Axle boxes of a wheelset, sides of a bogie."""


_SHORTEST = 1e-5
"""Shortest step that a scenario accepts, s."""


class StepLimit(NamedTuple):
    """The longest step in s with which the integration follows something, and what shifts that limit."""

    longest: float
    of: str
    keys: str

    @property
    def hint(self) -> str:
        """What to change."""
        if self.longest < _SHORTEST:
            return f"check {self.keys}; no step is short enough for these"
        longest = f"{self.longest * 1000.0:.3g} ms"
        return f"check {self.keys}; with these simulation.time_step must be at most {longest}"


class ValveConductances(NamedTuple):
    """Sonic conductances into a tank and out of it, through its WSP valve and its leaks, m3/(s Pa)."""

    fill: float
    vent: float


def limit_of_vehicle(vehicle: Vehicle) -> StepLimit:
    """Return the longest stable step and the motion of the car that limits it.

    Semi-implicit Euler with explicit damping keeps a motion of mass m, stiffness k and damping c bounded
    while k h2 + 2 c h < 4 m. Coupled to others a motion is at most twice as stiff (Gershgorin), so that
    k h2 + 2 c h <= 2 m is demanded of each.
    """
    longest, motion = min((_stable_step(mass, *coupling), name) for name, mass, coupling in _motions(vehicle))
    return StepLimit(longest, motion, "masses, stiffness and damping")


def limit_of_air(
    system: BrakeSystem,
    caliper: Caliper,
    smallest_tank: float,
    valves: Sequence[ValveConductances],
    line_leak: float = 0.0,
) -> StepLimit:
    """Return the longest step with which no pressure swings from step to step, and the air that limits it.

    Flows follow from the pressures at the beginning of a step. Where they grow by g kg/s per Pa, air of
    volume V answers at the rate kappa R T g / V (adiabatic: the quickest). A step of at most the inverse of
    that rate overshoots nowhere and, coupled to the air of others, stays bounded (Gershgorin).

    Args:
        system: the air supply, valves and tanks.
        caliper: the caliper whose piston moves the air of its module.
        smallest_tank: smallest volume of air in a module, m3.
        valves: the WSP valves of all wheelsets.
        line_leak: sonic conductance of the leaks of the brake line, m3/(s Pa).
    """
    vessels = _vessels(system, smallest_tank, valves, line_leak)
    return min((*vessels, _piston(system, caliper, smallest_tank)))


def _vessels(
    system: BrakeSystem, smallest_tank: float, valves: Sequence[ValveConductances], line_leak: float
) -> Iterator[StepLimit]:
    relay = system.relay_valve
    steepest = orifice_law(float(system.critical_pressure_ratio), float(system.laminar_pressure_ratio))[2]
    supply = max(system.reservoir.initial_pressure, system.compressor.cut_out_pressure)
    opened = (supply + system.air.atmospheric_pressure) / relay.proportional_band
    through_relay = relay.conductance * (steepest + opened)
    for volume, conductance, of, keys in (
        (
            smallest_tank,
            max(valve.fill + valve.vent for valve in valves) * steepest,
            "the air in a tank",
            "tank volumes and the conductances of wsp_valve",
        ),
        (
            system.brake_line.volume,
            (total(valve.fill for valve in valves) + line_leak) * steepest + through_relay,
            "the air in the brake line",
            "brake_line.volume, relay_valve and wsp_valve.fill_conductance",
        ),
        (
            system.reservoir.volume,
            through_relay,
            "the air in the reservoir",
            "reservoir.volume and relay_valve",
        ),
    ):
        yield StepLimit(volume / (_stiffness_of_air(system) * REFERENCE_DENSITY * conductance), of, keys)


def _stiffness_of_air(system: BrakeSystem) -> float:
    """Adiabatic change of p V per mass of air, kappa R T in J/kg."""
    air = system.air
    return air.heat_capacity_ratio * air.gas_constant * air.temperature


def _piston(system: BrakeSystem, caliper: Caliper, smallest_tank: float) -> StepLimit:
    """Return the limit of a free piston, whose stroke answers to the pressure of the last step.

    The air pushes back by kappa p A2 / V, N/m, which the spring and, within a step h, the viscous friction
    c / h must exceed.
    """
    largest = max(position.maximum_pressure for position in system.positions.values())
    pressure = largest + system.air.atmospheric_pressure
    air_spring = system.air.heat_capacity_ratio * pressure * caliper.piston_area**2 / smallest_tank
    unheld = air_spring - caliper.spring_rate
    longest = math.inf if unheld <= 0.0 else caliper.viscous_friction / unheld
    return StepLimit(longest, "the free piston of the caliper", "piston_area and viscous_friction")


def _stable_step(mass: float, stiffness: float, damping: float) -> float:
    root: float = (damping**2 + 2.0 * stiffness * mass) ** 0.5  # unlike `math.sqrt`, of an ensemble as well
    return (root - damping) / stiffness


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
    rod = (link.stiffness, link.damping)

    def pitch(height: float) -> list[tuple[float, _Coupling]]:
        return [((secondary.height - height) ** 2, side_pull), ((link.height - height) ** 2, rod)]

    on_axles = max((bogie.height - radius) ** 2 for radius in vehicle.wheel_radii)
    return [
        ("a wheelset on its primary suspension", wheelset.mass, pull),
        ("the longitudinal motion", bogie.mass, _sum((2.0, pull), (1.0, side_pull), (1.0, rod))),
        ("the bounce of a bogie", bogie.mass, _sum((2.0, lift), (1.0, side_lift))),
        (
            "the pitch of a bogie",
            bogie.pitch_inertia,
            _sum((2.0 * on_axles, pull), (2.0 * bogie.half_wheelbase**2, lift), *pitch(bogie.height)),
        ),
        ("the longitudinal motion", body.mass, _sum((2.0, side_pull), (2.0, rod))),
        ("the bounce of the body", body.mass, _sum((2.0, side_lift))),
        (
            "the pitch of the body",
            body.pitch_inertia,
            _sum((2.0 * vehicle.half_pivot_distance**2, side_lift), *pitch(body.height), *pitch(body.height)),
        ),
    ]


def _sum(*parts: tuple[float, _Coupling]) -> _Coupling:
    return total(share * k for share, (k, _) in parts), total(share * c for share, (_, c) in parts)
