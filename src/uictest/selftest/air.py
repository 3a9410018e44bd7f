"""Known answers of the air: closed forms of thermodynamics, and a published density."""

import math
from typing import Final

from uictest.core import physics
from uictest.selftest.check import Answer, Check
from uictest.selftest.known_stops import KnownStops

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
"""Heat conductance within a step, J/K, beside which the heat capacity of the air is nothing."""


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


def _filled_tank(stops: KnownStops) -> Answer:
    return Answer(_RATIO * _WARM, _temperature_after(0.01, _WARM, 0.01))


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


def _choked_flow(stops: KnownStops) -> Answer:
    return Answer(1.185e-3, physics.mass_flow(1e5, 0.0, 1.0, 1.0, _CONDUCTANCE, *_LAW))


AIR_CHECKS: Final = (
    Check(
        "adiabatic-tank",
        "physics",
        "an evacuated tank, filled without heat: k T outside",
        *(_filled_tank, 1e-12, "K"),
    ),
    Check(
        "isothermal-tank",
        "physics",
        "choked blow-down at one temperature: pressure left after 0.1 s, an exponential",
        *(_blown_down_tank, 1e-5, "1"),
    ),
    Check(
        "choked-orifice",
        "physics",
        "1 l/(s bar) at 1 bar carries the density of ISO 8778",
        *(_choked_flow, 1e-12, "kg/s"),
    ),
)
