"""Whether a train of one's own can be one: quantities that follow from several numbers, and plausible spans.

Two real trains lie outside of some range of the library's cars; what follows from several numbers differs
less from train to train, so that a wide span finds a slip of the pen.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from typing import Any

import yaml

from uictest.core.physics import REFERENCE_DENSITY
from uictest.core.units import PERCENT, SIZES, STANDARD_GRAVITY
from uictest.plans import library
from uictest.plans.scenario.brake_force import braking_forces, mass_with_rotation
from uictest.plans.scenario.parts.wheelsets import distinct_values
from uictest.plans.scenario.sections import load_share
from uictest.plans.scenario.yaml import dotted


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
    derived = list(_derived(scenario))
    values = {name: value for name, value, _ in derived}
    beyond = tuple(each for row in derived for each in _implausible(*row))
    mass = scenario.vehicle.total_mass / SIZES["t"]
    return CarFigures(mass, values["axle-load"], values["braked-weight-percentage"], beyond)


def _implausible(name: str, value: float, key: str) -> Iterator[Implausible]:
    row = plausible_spans()[name]
    lowest, highest = row["span"]
    if not lowest <= value <= highest:
        keys = (key or row["keys"][0], *row["keys"][1:])
        likely = row["below" if value < lowest else "above"]
        yield Implausible(name, row["title"], value, row["unit"], (lowest, highest), keys, likely)


def _derived(scenario: Any) -> Iterator[tuple[str, float, str]]:
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
