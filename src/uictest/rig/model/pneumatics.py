"""From the brake command to the air: reservoir, relay valve and brake line; WSP valve and tank of one module.

Each command begins a ramp from the pressure that is demanded then.
"""

from collections.abc import Sequence

from uictest.core.measures import StopMeasures
from uictest.core.physics import (
    air_changes,
    coldness,
    compressor_running,
    demanded_pressure,
    enthalpy,
    fma,
    friction_pressure,
    isothermal_pressure,
    mass_flow,
    maximum,
    relay_opening,
    select,
    travel,
)
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.state import Car, Wheelset


def step_air(car: Car, wheelsets: Sequence[Wheelset], p: Parameters) -> None:
    """Let air flow through all valves, then advance what it flows into and out of.

    Each valve and each tank is a chain of dependent operations. A processor works on several chains at once
    where they stand side by side, which is why no tank is filled before the flows of all are known.
    """
    car.command_pressure = demanded_pressure(
        car.time, car.demand_start, car.demand_change, car.demand_begins, car.demand_rate
    )
    car.demanded_pressure = friction_pressure(car.command_pressure, car.blended_share, p.zero_force_pressure)
    drawn_0, vented_0 = _step_valve(wheelsets[0], car, p)
    drawn_1, vented_1 = _step_valve(wheelsets[1], car, p)
    drawn_2, vented_2 = _step_valve(wheelsets[2], car, p)
    drawn_3, vented_3 = _step_valve(wheelsets[3], car, p)
    filled, exhausted = _through_relay_valve(car, p)
    enthalpy_0 = _fill_tank(wheelsets[0], drawn_0, vented_0, car, p)
    enthalpy_1 = _fill_tank(wheelsets[1], drawn_1, vented_1, car, p)
    enthalpy_2 = _fill_tank(wheelsets[2], drawn_2, vented_2, car, p)
    enthalpy_3 = _fill_tank(wheelsets[3], drawn_3, vented_3, car, p)
    _step_reservoir(car, filled, p)
    drawn = drawn_0 + drawn_1 + drawn_2 + drawn_3
    _fill_line(car, filled, exhausted, drawn, enthalpy_0 + enthalpy_1 + enthalpy_2 + enthalpy_3, p)


def follow_demanded_pressure(car: Car, drawn: float, drawn_enthalpy: float, p: Parameters) -> None:
    """Let the relay valve bring the brake line towards ``car.demanded_pressure``, whatever sets that."""
    filled, exhausted = _through_relay_valve(car, p)
    _step_reservoir(car, filled, p)
    _fill_line(car, filled, exhausted, drawn, drawn_enthalpy, p)


def step_tank(wheelset: Wheelset, car: Car, p: Parameters) -> tuple[float, float]:
    """Advance the WSP valve and the tank of one module.

    Returns:
        The air drawn from the brake line, kg, and its enthalpy, J.
    """
    drawn, vented = _step_valve(wheelset, car, p)
    return drawn, _fill_tank(wheelset, drawn, vented, car, p)


def _fill_tank(wheelset: Wheelset, drawn: float, vented: float, car: Car, p: Parameters) -> float:
    """Let a tank gain ``drawn`` kg and lose ``vented`` kg; return the enthalpy of what it gained, J."""
    drawn_enthalpy = enthalpy(drawn, car.line_temperature, wheelset.air_temperature, p.heat_capacity_pressure)
    vented_enthalpy = enthalpy(vented, wheelset.air_temperature, p.air_temperature, p.heat_capacity_pressure)
    has_caliper = wheelset.has_caliper > 0.0
    volume = module_volume(wheelset, p)
    exchange = select(has_caliper, p.caliper_tank_exchange, p.tank_exchange)
    growth = wheelset.has_caliper * p.piston_area * wheelset.stroke_change
    wheelset.air_mass += drawn - vented
    warming, rise = air_changes(
        wheelset.pressure,
        wheelset.air_temperature,
        wheelset.air_mass,
        drawn - vented,
        drawn_enthalpy - vented_enthalpy,
        volume,
        growth,
        p.air_temperature,
        exchange,
        p.gas_constant,
        p.heat_capacity_volume,
    )
    wheelset.piston_work += wheelset.pressure * growth
    wheelset.air_temperature += warming
    wheelset.pressure += rise
    wheelset.air_coldness = coldness(wheelset.air_temperature)
    wheelset.vented_air += vented
    wheelset.vented_enthalpy += vented_enthalpy
    wheelset.wall_heat += exchange * (p.air_temperature - wheelset.air_temperature)
    return drawn_enthalpy


def module_volume(wheelset: Wheelset, p: Parameters) -> float:
    """Volume of the air of one module with its piston where it is, m3."""
    has_caliper = wheelset.has_caliper > 0.0
    swept = wheelset.has_caliper * p.piston_area
    return fma(swept, wheelset.stroke, select(has_caliper, p.caliper_tank_volume, p.tank_volume))


def _fill_line(
    car: Car, filled: float, exhausted: float, drawn: float, drawn_enthalpy: float, p: Parameters
) -> None:
    """Let the brake line gain ``filled`` kg and lose what is let out and what the tanks draw."""
    supplied = enthalpy(filled, p.air_temperature, car.line_temperature, p.heat_capacity_pressure)
    released = enthalpy(exhausted, car.line_temperature, p.air_temperature, p.heat_capacity_pressure)
    gained = filled - exhausted - drawn
    car.line_mass += gained
    warming, rise = air_changes(
        car.line_pressure,
        car.line_temperature,
        car.line_mass,
        gained,
        supplied - released - drawn_enthalpy,
        p.line_volume,
        0.0,
        p.air_temperature,
        p.line_exchange,
        p.gas_constant,
        p.heat_capacity_volume,
    )
    car.line_temperature += warming
    car.line_pressure += rise
    car.line_coldness = coldness(car.line_temperature)
    car.consumed_air += filled
    car.exhausted_air += exhausted
    car.supplied_enthalpy += supplied
    car.exhausted_enthalpy += released
    car.line_heat += p.line_exchange * (p.air_temperature - car.line_temperature)


def move_valve(wheelset: Wheelset, car: Car) -> None:
    """Let the WSP valve of one module travel towards what it is commanded."""
    switched = car.substep >= wheelset.valve_delay_steps
    fill_target = select(switched, wheelset.fill_after, wheelset.fill_before)
    vent_target = select(switched, wheelset.vent_after, wheelset.vent_before)
    wheelset.fill_opening = travel(wheelset.fill_opening, fill_target, wheelset.valve_travel_per_step)
    wheelset.vent_opening = travel(wheelset.vent_opening, vent_target, wheelset.valve_travel_per_step)


def _step_valve(wheelset: Wheelset, car: Car, p: Parameters) -> tuple[float, float]:
    """Move the WSP valve of one module; return the air that it lets into the tank and out of it, kg."""
    move_valve(wheelset, car)
    drawn = p.step * orifice(
        car.line_pressure,
        wheelset.pressure,
        car.line_coldness,
        wheelset.air_coldness,
        wheelset.fill_conductance * wheelset.fill_opening,
        p,
    )
    vented = p.step * orifice(
        wheelset.pressure,
        p.atmospheric_pressure,
        wheelset.air_coldness,
        p.air_coldness,
        wheelset.vent_conductance * wheelset.vent_opening,
        p,
    )
    return drawn, vented


def _through_relay_valve(car: Car, p: Parameters) -> tuple[float, float]:
    """Air that flows in a step from the reservoir into the brake line and from it to the atmosphere, kg."""
    gauge = car.line_pressure - p.atmospheric_pressure
    opening = relay_opening(car.demanded_pressure, gauge, p.relay_gain)
    filled = p.step * orifice(
        car.reservoir_pressure,
        car.line_pressure,
        p.air_coldness,
        car.line_coldness,
        p.relay_conductance * maximum(opening, 0.0),
        p,
    )
    exhausted = p.step * orifice(
        car.line_pressure,
        p.atmospheric_pressure,
        car.line_coldness,
        p.air_coldness,
        p.relay_conductance * maximum(-opening, 0.0),
        p,
    )
    return filled, exhausted


def _step_reservoir(car: Car, filled: float, p: Parameters) -> None:
    car.compressor_running = compressor_running(
        car.reservoir_pressure, car.compressor_running, p.compressor_cut_in, p.compressor_cut_out
    )
    delivered = p.step * p.compressor_delivery * car.compressor_running
    car.reservoir_mass += delivered - filled
    car.reservoir_pressure = isothermal_pressure(car.reservoir_mass, p.reservoir_stiffness)
    car.compressor_air += delivered


def orifice(
    pressure_1: float,
    pressure_2: float,
    coldness_1: float,
    coldness_2: float,
    conductance: float,
    p: Parameters,
) -> float:
    """Mass flow through an orifice of the rig, kg/s: :func:`uictest.core.physics.air.mass_flow`."""
    return mass_flow(
        pressure_1,
        pressure_2,
        coldness_1,
        coldness_2,
        conductance,
        p.critical_ratio,
        p.subsonic_scale,
        p.laminar_slope,
    )


_NAN = float("nan")


def start_command(car: Car, p: Parameters) -> None:
    """Let the first command be in effect."""
    car.demand_change = p.commanded_pressure
    car.demand_begins = p.dead_time
    car.demand_rate = p.filling_rate
    car.brake_command = p.first_command


def follow_commands(car: Car, measures: StopMeasures, p: Parameters) -> None:
    """Give further commands, and let the last one take effect whose dead time has passed; scalar code.

    A command that a later one overtakes never takes effect. Only of the first application is it known when it
    has built up: a further command ends what observes that.
    """
    now = car.time + 0.5 * p.step
    effective = car.command_place
    for k in range(car.command_place + 1, p.command_count):
        if now >= p.command_given[k]:
            car.brake_command = p.command_shares[k]
        if now >= p.command_times[k]:
            effective = k
    if effective > car.command_place:
        if p.command_pressures[car.command_place] == 0.0:
            car.dynamic_dropped = 0.0  # another application begins
        car.command_place = effective
        _begin_ramp(car, p)
        if car.closed == 0.0:
            measures.commanded_pressure = _NAN


def _begin_ramp(car: Car, p: Parameters) -> None:
    k = car.command_place
    change = p.command_pressures[k] - car.command_pressure
    rate = p.command_rates[k] if change > 0.0 else p.release_rates[k]
    car.demand_start = car.command_pressure
    car.demand_change = change
    car.demand_begins = car.time
    car.demand_rate = rate / abs(change) if change != 0.0 else 0.0
