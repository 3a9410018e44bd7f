"""What no stop can do: stops without end, pole wheels that cannot be.

And the longest step with which the integration follows the car on its springs and the air behind its valves.
"""

import math
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import Any, Final, NamedTuple

from uictest.core.physics import REFERENCE_DENSITY, orifice_law
from uictest.core.units import STANDARD_GRAVITY
from uictest.plans.scenario.brake_force import running_resistance
from uictest.plans.scenario.files import Files
from uictest.plans.scenario.parts.brake import BrakeSystem, Caliper
from uictest.plans.scenario.parts.criteria import Criteria
from uictest.plans.scenario.parts.vehicle import Vehicle
from uictest.plans.scenario.parts.wheelsets import WHEELSET_NUMBERS, deciding_key, wheelset_value
from uictest.plans.scenario.references import Parts
from uictest.plans.scenario.yaml import Document, Inconsistency, Model, Place, Scalar, total


def stopping_time_at_least(scenario: Any) -> float:
    """Return the shortest time, s, of the stop of a scenario; infinite if its car never stops.

    The largest friction, the gradient, the running resistance at the initial speed, the largest force of a
    track brake and a held speed act in full until the end.
    """
    speed, vehicle = scenario.initial_speed, scenario.vehicle
    drag = running_resistance(vehicle, speed)
    if scenario.brake.track is not None:
        drag += scenario.brake.track.largest_force
    friction = highest_friction(scenario) + scenario.rail.gradient
    deceleration = STANDARD_GRAVITY * friction + drag / vehicle.total_mass
    shortest = speed / deceleration if deceleration > 0.0 else math.inf
    if scenario.until is not None:  # not slowed more than at the beginning, all the way
        shortest *= 1.0 - scenario.until / speed
    return shortest if scenario.drag is None else shortest + scenario.drag.duration


def highest_friction(scenario: Any) -> float:
    """Return the highest friction coefficient that a wheelset can meet."""
    rail = scenario.rail
    found: float = rail.highest_friction_after_cleaning
    return max(found, rail.sand.friction) if scenario.sanders else found


RIG_CHECKS: Final = "uictest-rig"
"""Name of the profile."""


@cache
def rig_checks() -> Criteria:
    """Return the profile."""
    place = Place(Document(RIG_CHECKS, Path(), RIG_CHECKS))
    profile: Criteria = Parts(Files()).part(Scalar(RIG_CHECKS, RIG_CHECKS, place), Criteria, ()).part
    return profile


def tank_leak(scenario: Any, number: int) -> float:
    """Return the conductance of all leaks of the tank of a wheelset, 1 to 4, m3/(s Pa)."""
    return math.fsum(fault.effects.tank_leak for fault in scenario.faults if fault.wheelset == number)


def line_leak(scenario: Any) -> float:
    """Return the conductance of all leaks of the brake line, m3/(s Pa)."""
    return math.fsum(fault.effects.line_leak for fault in scenario.faults)


def impossible_pole_wheels(scenario: Model) -> Iterator[Inconsistency]:
    """Yield settings of the speed sensors that no pole wheel can have, for every wheelset."""
    names = [f"sensors.speed.{name}" for name in ("missing_teeth", "teeth", "method")]
    for number in WHEELSET_NUMBERS:
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
    longest, motion = min(
        # The power, unlike `math.sqrt`, is that of an ensemble as well.
        (((damping**2 + 2.0 * stiffness * mass) ** 0.5 - damping) / stiffness, name)
        for name, mass, (stiffness, damping) in _motions(vehicle)
    )
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


def _steepest_flow(*ratios: Any) -> Any:
    """Return the steepest flow through an orifice of one case, or of several."""
    if all(isinstance(ratio, float) for ratio in ratios):
        return orifice_law(*map(float, ratios))[2]
    from uictest.core.ensemble import case_by_case  # with numpy, which `uictest check` does not need

    return case_by_case(orifice_law, *ratios)[2]


def _vessels(
    system: BrakeSystem, smallest_tank: float, valves: Sequence[ValveConductances], line_leak: float
) -> Iterator[StepLimit]:
    relay = system.relay_valve
    ratios = system.critical_pressure_ratio, system.laminar_pressure_ratio
    steepest = _steepest_flow(*ratios)
    supply = max(system.reservoir.initial_pressure, system.compressor.cut_out_pressure)
    opened = (supply + system.air.atmospheric_pressure) / relay.proportional_band
    through_relay = relay.conductance * (steepest + opened)
    air = system.air
    stiffness = air.heat_capacity_ratio * air.gas_constant * air.temperature  # d(p V)/dm, adiabatic, J/kg
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
        yield StepLimit(volume / (stiffness * REFERENCE_DENSITY * conductance), of, keys)


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


_Coupling = tuple[float, float]
"""Stiffness and damping."""


def _motions(vehicle: Vehicle) -> list[tuple[str, float, _Coupling]]:
    body, bogie, wheelset = vehicle.loaded_body, vehicle.bogie, vehicle.wheelset
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
