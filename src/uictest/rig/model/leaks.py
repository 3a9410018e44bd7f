"""Air that leaks from tanks and from the brake line: in lanes, only in stops with such a fault."""

from collections.abc import Sequence

from uictest.core.physics import air_changes, coldness, enthalpy
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.pneumatics import module_volume, orifice
from uictest.rig.model.state import Car, Wheelset


def let_air_leak(car: Car, wheelsets: Sequence[Wheelset], p: Parameters) -> None:
    """Let air leak for one step, before the valves and walls do their part in it."""
    for i in range(4):
        _leak_from_tank(wheelsets[i], p)
    _leak_from_line(car, p)


def _leak_from_tank(wheelset: Wheelset, p: Parameters) -> None:
    leaked = p.step * orifice(
        wheelset.pressure,
        p.atmospheric_pressure,
        wheelset.air_coldness,
        p.air_coldness,
        wheelset.tank_leak,
        p,
    )
    lost = enthalpy(leaked, wheelset.air_temperature, p.air_temperature, p.heat_capacity_pressure)
    wheelset.air_mass -= leaked
    warming, rise = _changes(
        wheelset.pressure,
        wheelset.air_temperature,
        wheelset.air_mass,
        leaked,
        lost,
        module_volume(wheelset, p),
        p,
    )
    wheelset.air_temperature += warming
    wheelset.pressure += rise
    wheelset.air_coldness = coldness(wheelset.air_temperature)
    wheelset.leaked_air += leaked
    wheelset.leaked_enthalpy += lost


def _leak_from_line(car: Car, p: Parameters) -> None:
    leaked = p.step * orifice(
        car.line_pressure, p.atmospheric_pressure, car.line_coldness, p.air_coldness, car.line_leak, p
    )
    lost = enthalpy(leaked, car.line_temperature, p.air_temperature, p.heat_capacity_pressure)
    car.line_mass -= leaked
    warming, rise = _changes(
        car.line_pressure, car.line_temperature, car.line_mass, leaked, lost, p.line_volume, p
    )
    car.line_temperature += warming
    car.line_pressure += rise
    car.line_coldness = coldness(car.line_temperature)
    car.leaked_air += leaked
    car.leaked_enthalpy += lost


def _changes(
    pressure: float,
    temperature: float,
    mass: float,
    leaked: float,
    lost: float,
    volume: float,
    p: Parameters,
) -> tuple[float, float]:
    """Changes of temperature and pressure of air in a fixed volume that loses so many kg and J."""
    return air_changes(
        pressure,
        temperature,
        mass,
        -leaked,
        -lost,
        volume,
        0.0,
        p.air_temperature,
        0.0,
        p.gas_constant,
        p.heat_capacity_volume,
    )
