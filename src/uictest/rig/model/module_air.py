"""Compensation `thermal`: the air that a caliper's module would hold, followed beside a tank.

It knows what the rig's computer knows: the readings of the tank's and the brake line's pressure, and how far
the valves are open under their commands.
"""

from collections.abc import Sequence

from uictest.core.physics import (
    amount_gained,
    analogue_reading,
    beyond_range,
    fma,
    pressure_volume_after,
    reduced_flow,
    select,
    travel_after,
)
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.state import Car, Wheelset


def follow_tanks(wheelsets: Sequence[Wheelset], line: float, p: Parameters) -> None:
    """Advance the modelled air by one base step, before the rig itself is stepped.

    The first module always has a caliper, and what is modelled beside a caliper nothing reads.
    """
    for i in range(1, 4):
        follow_tank(wheelsets[i], line, p)


def read_line_pressure(car: Car, p: Parameters) -> float:
    """Return the absolute pressure of the brake line in Pa, as its sensor reads it where air is modelled."""
    actual = car.line_pressure - p.atmospheric_pressure
    car.line_saturated_steps += p.uses_module_air * beyond_range(
        actual, p.line_sensor_gain_error, p.line_sensor_offset, car.line_pressure_error, p.pressure_range
    )
    gauge = analogue_reading(
        actual,
        p.line_sensor_gain_error,
        p.line_sensor_offset,
        car.line_pressure_error,
        p.pressure_range,
        p.pressure_resolution,
        p.pressure_steps,
    )
    return gauge + p.atmospheric_pressure


def follow_tank(wheelset: Wheelset, line: float, p: Parameters) -> None:
    """Advance the modelled air of one module: what flowed into its tank, then what would have flowed."""
    tank = wheelset.pressure_reading + p.atmospheric_pressure
    gained = amount_gained(
        wheelset.modelled_tank_pressure,
        tank - wheelset.modelled_tank_pressure,
        wheelset.modelled_tank_air,
        p.modelled_tank_exchange,
        p.heat_capacity_ratio,
    )
    difference = _through_valve(
        wheelset, line, wheelset.modelled_pressure, wheelset.modelled_volume, wheelset.modelled_air, p
    ) - _through_valve(wheelset, line, wheelset.modelled_tank_pressure, 1.0, wheelset.modelled_tank_air, p)
    wheelset.modelled_tank_pressure = tank
    wheelset.modelled_tank_air += gained
    _follow_cylinder(wheelset, gained + difference, p)
    wheelset.pressure_ratio = wheelset.modelled_pressure / tank


def _through_valve(
    wheelset: Wheelset, line: float, pressure: float, volume: float, air: float, p: Parameters
) -> float:
    """Air that the WSP valve, as far as it is open, lets into a module of this pressure within a step, Pa."""
    vents = wheelset.vent_opening > wheelset.fill_opening
    conductance = select(
        vents,
        p.modelled_vent_conductance * wheelset.vent_opening,
        p.modelled_fill_conductance * wheelset.fill_opening,
    )
    flow = reduced_flow(
        select(vents, p.atmospheric_pressure, line),
        pressure,
        p.air_coldness,
        p.air_coldness * air / (pressure * volume),
        p.critical_ratio,
        p.subsonic_scale,
        p.laminar_slope,
    )
    return conductance * flow


def _follow_cylinder(wheelset: Wheelset, gained: float, p: Parameters) -> None:
    pressure_volume = pressure_volume_after(
        wheelset.modelled_pressure,
        wheelset.modelled_volume,
        wheelset.modelled_growth,
        wheelset.modelled_air,
        gained,
        p.modelled_exchange,
        p.heat_capacity_ratio,
    )
    travel = travel_after(
        wheelset.modelled_travel,
        pressure_volume,
        p.modelled_swept_share,
        p.modelled_closing_pressure,
        p.modelled_opening_pressure,
    )
    volume = fma(p.modelled_swept_share, travel - 1.0, 1.0)
    wheelset.modelled_growth = volume - wheelset.modelled_volume
    wheelset.modelled_travel = travel
    wheelset.modelled_volume = volume
    wheelset.modelled_air += gained
    wheelset.modelled_pressure = pressure_volume / volume
