"""Air of the rig: reservoir, relay valve and brake line; WSP valve and tank of one module."""

from uictest.physics import (
    compressor_running,
    demanded_pressure,
    fma,
    isothermal_pressure,
    mass_flow,
    maximum,
    pressure_change,
    relay_opening,
    select,
    travel,
)
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.state import Car, Wheelset


def step_supply(car: Car, drawn: float, p: Parameters) -> None:
    """Advance compressor, reservoir, relay valve and the brake line, which lost ``drawn`` kg to the tanks."""
    car.demanded_pressure = demanded_pressure(car.time, p.commanded_pressure, p.dead_time, p.filling_rate)
    follow_demanded_pressure(car, drawn, p)


def follow_demanded_pressure(car: Car, drawn: float, p: Parameters) -> None:
    """Let the relay valve bring the brake line towards ``car.demanded_pressure``, whatever sets that."""
    gauge = car.line_pressure - p.atmospheric_pressure
    opening = relay_opening(car.demanded_pressure, gauge, p.relay_gain)
    filled, exhausted = _through(
        car.reservoir_pressure,
        car.line_pressure,
        p.relay_conductance * maximum(opening, 0.0),
        p.relay_conductance * maximum(-opening, 0.0),
        p,
    )
    car.compressor_running = compressor_running(
        car.reservoir_pressure, car.compressor_running, p.compressor_cut_in, p.compressor_cut_out
    )
    delivered = p.step * p.compressor_delivery * car.compressor_running
    car.reservoir_mass += delivered - filled
    car.reservoir_pressure = isothermal_pressure(car.reservoir_mass, p.reservoir_stiffness)
    gained = filled - exhausted - drawn
    car.line_mass += gained
    car.line_pressure += pressure_change(car.line_pressure, p.line_stiffness, gained, 0.0, p.air)
    car.compressor_air += delivered
    car.consumed_air += filled
    car.exhausted_air += exhausted


def step_tank(wheelset: Wheelset, car: Car, p: Parameters) -> float:
    """Advance the WSP valve and the tank of one module; return the air drawn from the brake line, kg."""
    switched = car.substep >= p.valve_delay_steps
    fill_target = select(switched, wheelset.fill_after, wheelset.fill_before)
    vent_target = select(switched, wheelset.vent_after, wheelset.vent_before)
    wheelset.fill_opening = travel(wheelset.fill_opening, fill_target, p.valve_travel_per_step)
    wheelset.vent_opening = travel(wheelset.vent_opening, vent_target, p.valve_travel_per_step)
    drawn, vented = _through(
        car.line_pressure,
        wheelset.pressure,
        p.fill_conductance * wheelset.fill_opening,
        p.vent_conductance * wheelset.vent_opening,
        p,
    )
    swept = wheelset.has_caliper * p.piston_area
    fixed = select(wheelset.has_caliper > 0.0, p.caliper_tank_volume, p.tank_volume)
    stiffness = p.polytropic_exponent / fma(swept, wheelset.stroke, fixed)
    growth = swept * wheelset.stroke_change
    wheelset.air_mass += drawn - vented
    wheelset.vented_air += vented
    wheelset.pressure += pressure_change(wheelset.pressure, stiffness, drawn - vented, growth, p.air)
    return drawn


def _through(
    source: float, vessel: float, conductance_in: float, conductance_out: float, p: Parameters
) -> tuple[float, float]:
    """Air that flows in a step from a source into a vessel and from there to the atmosphere, kg."""
    gained = p.step * _orifice(source, vessel, conductance_in, p)
    return gained, p.step * _orifice(vessel, p.atmospheric_pressure, conductance_out, p)


def _orifice(pressure_1: float, pressure_2: float, conductance: float, p: Parameters) -> float:
    return mass_flow(
        pressure_1,
        pressure_2,
        conductance,
        p.flow_density,
        p.critical_ratio,
        p.subsonic_scale,
        p.laminar_slope,
    )
