"""What no stop can do, and what no train is like.

Stops without end, pole wheels that cannot be; the longest step with which the integration follows the car on
its springs and the air behind its valves. And whether a train of one's own can be one: two real trains lie
outside of some range of the library's cars; what follows from several numbers differs less from train to
train, so that a wide span finds a slip of the pen.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache, partial
from typing import Any, NamedTuple

import yaml

from uictest.core import physics
from uictest.core.physics import REFERENCE_DENSITY, orifice_law
from uictest.core.units import PERCENT, SIZES, STANDARD_GRAVITY
from uictest.plans import library
from uictest.plans.scenario.parts.compensation import Compensation
from uictest.plans.scenario.parts.equipment import BrakeSystem, Caliper
from uictest.plans.scenario.parts.fault import SPEED
from uictest.plans.scenario.parts.vehicle import (
    WHEELSET_NUMBERS,
    Vehicle,
    deciding_key,
    distinct_values,
    load_share,
    wheelset_value,
)
from uictest.plans.scenario.yaml import DEFAULT_SOURCE, Inconsistency, Model, dotted, total


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
        """Hint on the value to change."""
        if self.longest < _SHORTEST:
            return f"check {self.keys}; no step is short enough for these"
        longest = f"{self.longest * 1000.0:.3g} ms"
        return f"check {self.keys}; with these simulation.time_step must be at most {longest}"


def limit_of_vehicle(vehicle: Vehicle) -> StepLimit:
    """Return the longest stable step and the motion of the car that limits it.

    Semi-implicit Euler with explicit damping keeps a motion of mass m, stiffness k and damping c bounded
    while k h2 + 2 c h < 4 m. Coupled to others a motion is at most twice as stiff (Gershgorin), so that
    k h2 + 2 c h <= 2 m is demanded of each.
    """
    longest, motion = min(
        ((math.sqrt(damping**2 + 2.0 * stiffness * mass) - damping) / stiffness, name)
        for name, mass, (stiffness, damping) in _motions_of_vehicle(vehicle)
    )
    return StepLimit(longest, motion, "masses, stiffness and damping")


def limit_of_air(
    system: BrakeSystem,
    caliper: Caliper,
    smallest_tank: float,
    valves: Sequence[tuple[float, float]],
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
        valves: sonic conductances into each tank and out of it, by its WSP valve and leaks, m3/(s Pa).
        line_leak: sonic conductance of the leaks of the brake line, m3/(s Pa).
    """
    vessels = _vessel_limits(system, smallest_tank, valves, line_leak)
    return min((*vessels, _piston_limit(system, caliper, smallest_tank)))


def _vessel_limits(
    system: BrakeSystem, smallest_tank: float, valves: Sequence[tuple[float, float]], line_leak: float
) -> Iterator[StepLimit]:
    relay = system.relay_valve
    ratios = system.critical_pressure_ratio, system.laminar_pressure_ratio
    _, _, steepest = orifice_law(*map(float, ratios))
    supply = max(system.reservoir.initial_pressure, system.compressor.cut_out_pressure)
    opened = (supply + system.air.atmospheric_pressure) / relay.proportional_band
    through_relay = relay.conductance * (steepest + opened)
    air = system.air
    stiffness = air.heat_capacity_ratio * air.gas_constant * air.temperature  # d(p V)/dm, adiabatic, J/kg
    for volume, conductance, of, keys in (
        (
            smallest_tank,
            max(fill + vent for fill, vent in valves) * steepest,
            "the air in a tank",
            "tank volumes and the conductances of wsp_valve",
        ),
        (
            system.brake_line.volume,
            (total(fill for fill, _ in valves) + line_leak) * steepest + through_relay,
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


def _piston_limit(system: BrakeSystem, caliper: Caliper, smallest_tank: float) -> StepLimit:
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


def _motions_of_vehicle(vehicle: Vehicle) -> list[tuple[str, float, _Coupling]]:
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
        ("the longitudinal motion", bogie.mass, _summed_coupling((2.0, pull), (1.0, side_pull), (1.0, rod))),
        ("the bounce of a bogie", bogie.mass, _summed_coupling((2.0, lift), (1.0, side_lift))),
        (
            "the pitch of a bogie",
            bogie.pitch_inertia,
            _summed_coupling(
                (2.0 * on_axles, pull), (2.0 * bogie.half_wheelbase**2, lift), *pitch(bogie.height)
            ),
        ),
        ("the longitudinal motion", body.mass, _summed_coupling((2.0, side_pull), (2.0, rod))),
        ("the bounce of the body", body.mass, _summed_coupling((2.0, side_lift))),
        (
            "the pitch of the body",
            body.pitch_inertia,
            _summed_coupling(
                (2.0 * vehicle.half_pivot_distance**2, side_lift), *pitch(body.height), *pitch(body.height)
            ),
        ),
    ]


def _summed_coupling(*parts: tuple[float, _Coupling]) -> _Coupling:
    return total(share * k for share, (k, _) in parts), total(share * c for share, (_, c) in parts)


def impossible_courses(scenario: Any) -> Iterator[Inconsistency]:
    """Yield speeds at which the stop of a scenario cannot end or be held, and a load that is not known."""
    until, drag, begins = scenario.until, scenario.drag, scenario.initial_speed
    if scenario.brake.system.load_valve is not None and scenario.vehicle.payload is None:
        yield Inconsistency(
            ("brake", "system", "load_valve"),
            "the vehicle has no payload that the pressure could follow",
            "say what it carries when full: vehicle.payload: 8 t",
        )
    if until is not None and until >= begins:
        yield Inconsistency(
            ("until",),
            f"the stop begins at {begins.text}, not above {until.text}",
            "write a speed below initial_speed",
        )
    if drag is not None and drag.speed > begins:
        yield Inconsistency(
            ("drag", "speed"),
            f"the train begins at {begins.text} and comes to no higher speed",
            "write initial_speed or less",
        )
    yield from _never_reached(scenario)
    if drag is not None and until is not None and until >= drag.speed:
        yield Inconsistency(
            ("until",),
            f"the stop would end before {drag.speed.text} is held",
            "write a speed below drag.speed",
        )


def _never_reached(scenario: Any) -> Iterator[Inconsistency]:
    longest, until = scenario.simulation.maximum_duration, scenario.until
    for index, (at, _, _) in enumerate(scenario.brake.commands):
        if at >= longest:
            yield Inconsistency(
                ("brake", "command", index, "at"),
                f"the stop ends after {longest.text} at the latest",
                "write an earlier time, or a longer simulation.maximum_duration",
            )
    for index, fault in enumerate(scenario.faults):
        if until is not None and fault.at.unit == SPEED and fault.at <= until:
            yield Inconsistency(
                ("faults", index, "at"),
                f"the stop ends at {until.text}, before {fault.at.text} is reached",
                "write a higher speed",
            )


def impossible_sanders(scenario: Any) -> Iterator[Inconsistency]:
    """Yield sanders that a scenario's car cannot have or that would never lay sand."""
    wheelbase = 2.0 * scenario.vehicle.bogie.half_wheelbase
    for index, sander in enumerate(scenario.sanders):
        key = ("sanders", index)
        if any(sander.wheelset == other.wheelset for other in scenario.sanders[:index]):
            yield Inconsistency((*key, "wheelset"), f"wheelset {sander.wheelset} has two sanders")
        if sander.distance > sander.share_of_wheelbase * wheelbase:
            yield Inconsistency(
                (*key, "distance"),
                f"{sander.distance.text} ahead the nozzle comes too near to the wheelset before it",
                f"at most {sander.share_of_wheelbase * wheelbase:.3g} m are accepted with this wheelbase",
            )
        if sander.when == "sliding" and scenario.rig.wsp == "bypassed":
            yield Inconsistency(
                (*key, "when"), "a bypassed WSP never acts", "write `when: always`, or `rig.wsp: active`"
            )
        if sander.when == "requested" and scenario.controller.program is None:
            yield Inconsistency(
                (*key, "when"),
                "no controller that is built in asks for sand",
                "write `when: sliding`, or name a controller from outside of contract version 2",
            )


def endless_stop(scenario: Any) -> Iterator[Inconsistency]:
    """Yield a stop that no brake can end within the longest duration that is simulated."""
    limit, shortest = scenario.simulation.maximum_duration, stopping_time_at_least(scenario)
    if shortest <= limit:
        return
    least = (
        "this car never stops" if shortest == math.inf else f"no brake stops this car within {shortest:.0f} s"
    )
    yield Inconsistency(
        ("initial_speed",) if limit.source == DEFAULT_SOURCE else ("simulation", "maximum_duration"),
        f"a stop from {scenario.initial_speed.text} cannot end within maximum_duration ({limit.text})",
        f"{least} with friction {highest_friction(scenario):g} and this gradient",
    )


@dataclass(frozen=True, slots=True)
class Implausible:
    """A derived quantity beyond its span, the keys that it follows from, and the mistake that is likely."""

    name: str
    title: str
    value: float
    unit: str
    span: tuple[float, float]
    keys: tuple[str, ...]
    likely: str

    def __str__(self) -> str:
        """Return the quantity, its value, the span and the keys for a reader."""
        unit, (lowest, highest) = "" if self.unit == "1" else f" {self.unit}", self.span
        value = f"{self.title} {self.value:.3g}{unit}, plausible {lowest:g} to {highest:g}{unit}"
        return f"{value} (from {', '.join(self.keys)})"


@dataclass(frozen=True, slots=True)
class CarFigures:
    """Mass, axle load and braked weight percentage of a car, and what of it is implausible."""

    mass_t: float
    axle_load_t: float
    braked_weight_percentage: float
    implausible: tuple[Implausible, ...] = ()


@cache
def plausible_spans() -> dict[str, dict[str, Any]]:
    """Return the rows of the library's `plausible.yaml` by the names of their quantities."""
    spans: dict[str, dict[str, Any]] = yaml.safe_load(library.table("plausible.yaml"))
    return spans


def car_figures(scenario: Any) -> CarFigures:
    """Return the figures of the car of a scenario, of its regular calipers at full service."""
    derived = list(_derived_quantities(scenario))
    values = {name: value for name, value, _ in derived}
    beyond = tuple(each for row in derived for each in _implausible_quantity(*row))
    mass = scenario.vehicle.total_mass / SIZES["t"]
    return CarFigures(mass, values["axle-load"], values["braked-weight-percentage"], beyond)


def _implausible_quantity(name: str, value: float, key: str) -> Iterator[Implausible]:
    row = plausible_spans()[name]
    lowest, highest = row["span"]
    if not lowest <= value <= highest:
        keys = (key or row["keys"][0], *row["keys"][1:])
        likely = row["below" if value < lowest else "above"]
        yield Implausible(name, row["title"], value, row["unit"], (lowest, highest), keys, likely)


def _derived_quantities(scenario: Any) -> Iterator[tuple[str, float, str]]:
    """Yield derived quantities in their units; and the key of the value of a wheelset, empty for the rest."""
    vehicle, system, caliper = scenario.vehicle, scenario.brake.system, scenario.rig.caliper
    wheelset, radii = vehicle.wheelset, vehicle.wheel_radii
    position = system.positions[scenario.brake.commands[0][2]]
    pressure = position.maximum_pressure * load_share(system.load_valve, vehicle)
    clamping = caliper.squeezing_force(pressure)
    forces = braking_forces(scenario, clamping)
    deceleration = sum(forces) / mass_with_rotation(vehicle)
    axle_load = vehicle.total_mass / len(radii)
    yield "axle-load", axle_load / SIZES["t"], ""
    for key, radius in distinct_values(scenario, "wheel_radius"):
        yield "wheel-radius", radius / SIZES["mm"], dotted(key)
    yield "braked-weight-percentage", braked_weight_percentage(deceleration), ""
    yield "adhesion-demand", max(forces) / (axle_load * STANDARD_GRAVITY), ""
    yield "wheel-inertia", wheelset.rotational_inertia / (wheelset.mass * wheelset.radius**2), ""
    yield "clamping-force", clamping / scenario.rig.sensors.loadcell.range / PERCENT, ""
    volume = len(radii) * system.tank.volume + system.brake_line.volume
    left = system.reservoir.initial_pressure - pressure * volume / system.reservoir.volume
    yield "reservoir", left / pressure, ""
    # Choked flow from the reservoir through the relay valve fills no sooner.
    air, supply = system.air, system.reservoir.initial_pressure + system.air.atmospheric_pressure
    flow = air.gas_constant * air.temperature * REFERENCE_DENSITY * system.relay_valve.conductance * supply
    yield "filling-time", position.dead_time + max(position.fill_time, volume * pressure / flow), ""
    yield "disc-radius", system.disc.mean_radius / wheelset.radius, ""
    yield "wheelbase", 2.0 * vehicle.bogie.half_wheelbase, ""


def braked_weight_percentage(deceleration: float) -> float:
    """Return lambda of a car that a built-up brake slows by so many m/s2: a = 0.0075 lambda + 0.076.

    The conversion model of ETCS for low speeds, valid for lambda from 30 to 250: SUBSET-026-3, A.3.7; read
    second-hand in github.com/cesarBLG/ETCS, EVC/Supervision/conversion_model.cpp. In UIC 544-1 lambda follows
    from a measured stopping distance.
    """
    return (deceleration - 0.076) / 0.0075
