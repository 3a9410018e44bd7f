"""The friction brake: from the pressure of a module to clamping force, discs and friction of the pads.

A module with a caliper gives what its loadcells read; one without has a tank, and a compensation computes the
force from the readings of its pressure. Discs and pads change slowly and are followed once per controller
cycle: the friction that the pads have at its beginning holds until its end, and the work that they did within
it then warms the discs at a constant rate.
"""

from collections.abc import Sequence

from uictest.core.physics import (
    amount_gained,
    analogue_reading,
    beyond_range,
    bulk_change,
    clamping_force,
    cooled_heat,
    fma,
    force_after,
    interpolated,
    line,
    memory,
    mode_after,
    output,
    phase_share,
    pressure_volume_after,
    quotient_factor,
    reduced_flow,
    select,
    stroke_after,
    travel_after,
)
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.state import Car, Wheelset


def step_clamping(wheelset: Wheelset, p: Parameters) -> None:
    """Advance caliper and compensation of one module and choose the force that the vehicle receives.

    A module with a caliper gives what its loadcells read. A module without one gives the force computed
    from its pressure sensor. Both have a computed force, so that it can be compared with the measured
    one.
    """
    step_caliper(wheelset, p)
    read_pressure(wheelset, p)
    compensate(wheelset, p)
    wheelset.clamping_force = select(
        wheelset.has_caliper > 0.0, read_loadcells(wheelset, p), wheelset.computed_force
    )


def read_pressure(wheelset: Wheelset, p: Parameters) -> None:
    """Read the pressure sensor of one module."""
    gauge = wheelset.pressure - p.atmospheric_pressure
    wheelset.pressure_reading = analogue_reading(
        gauge,
        wheelset.pressure_gain_error,
        wheelset.pressure_offset,
        wheelset.pressure_error,
        p.pressure_range,
        p.pressure_resolution,
        p.pressure_steps,
    )
    wheelset.pressure_saturated_steps += beyond_range(
        gauge,
        wheelset.pressure_gain_error,
        wheelset.pressure_offset,
        wheelset.pressure_error,
        p.pressure_range,
    )


def read_loadcells(wheelset: Wheelset, p: Parameters) -> float:
    """Clamping force in N that the loadcells of one module read."""
    wheelset.loadcell_saturated_steps += wheelset.has_caliper * beyond_range(
        wheelset.caliper_force,
        wheelset.loadcell_gain_error,
        wheelset.loadcell_offset,
        wheelset.loadcell_error,
        p.loadcell_range,
    )
    return analogue_reading(
        wheelset.caliper_force,
        wheelset.loadcell_gain_error,
        wheelset.loadcell_offset,
        wheelset.loadcell_error,
        p.loadcell_range,
        p.loadcell_resolution,
        p.loadcell_steps,
    )


def compensate(wheelset: Wheelset, p: Parameters) -> None:
    """Compute the clamping force of one module from the reading of its pressure."""
    _step_cylinder_pressure(wheelset, wheelset.pressure_reading, p)
    _step_hysteresis(wheelset, p)


def step_caliper(wheelset: Wheelset, p: Parameters) -> None:
    """Advance the caliper of one module, or the one that it would have, under the pressure of its air."""
    stroke = stroke_after(
        wheelset.stroke,
        wheelset.pressure - p.atmospheric_pressure,
        p.piston_area,
        p.preload,
        wheelset.coulomb_friction,
        p.clearance,
        p.piston_damping,
        p.contact_damping,
        wheelset.squeezing_stiffness,
        wheelset.releasing_stiffness,
        p.free_compliance,
        wheelset.squeezing_compliance,
        wheelset.releasing_compliance,
    )
    wheelset.stroke_change = stroke - wheelset.stroke
    wheelset.stroke = stroke
    wheelset.caliper_force = clamping_force(stroke, p.clearance, p.contact_stiffness, p.lever_ratio)


def _step_cylinder_pressure(wheelset: Wheelset, reading: float, p: Parameters) -> None:
    """Turn the reading of a tank into cylinder pressure; a caliper's own cylinder needs no such model."""
    filtered = output(reading, wheelset.memory_1, p.b0)
    wheelset.memory_1 = memory(reading, filtered, p.b1, p.a1, wheelset.memory_2)
    wheelset.memory_2 = memory(reading, filtered, p.b2, p.a2, wheelset.memory_3)
    wheelset.memory_3 = memory(reading, filtered, p.b3, p.a3, 0.0)
    filters = (1.0 - wheelset.has_caliper) * p.uses_cylinder_dynamics
    follows_air = (1.0 - wheelset.has_caliper) * p.uses_module_air
    modelled = fma(reading + p.atmospheric_pressure, wheelset.pressure_ratio, -p.atmospheric_pressure)
    wheelset.compensated_pressure = select(
        filters > 0.0, filtered, select(follows_air > 0.0, modelled, reading)
    )


def _step_hysteresis(wheelset: Wheelset, p: Parameters) -> None:
    pressure = wheelset.compensated_pressure
    share = phase_share(wheelset.wsp_share, wheelset.wsp_acting, p.phase_change_per_step)
    squeezing = line(
        pressure,
        fma(share, p.wsp_squeezing_slope - p.bc_squeezing_slope, p.bc_squeezing_slope),
        fma(share, p.wsp_squeezing_intercept - p.bc_squeezing_intercept, p.bc_squeezing_intercept),
    )
    releasing = line(
        pressure,
        fma(share, p.wsp_releasing_slope - p.bc_releasing_slope, p.bc_releasing_slope),
        fma(share, p.wsp_releasing_intercept - p.bc_releasing_intercept, p.bc_releasing_intercept),
    )
    wheelset.wsp_share = share
    hysteretic = force_after(wheelset.computed_force, squeezing, releasing)
    linear = line(pressure, p.linear_slope, p.linear_intercept)
    modelled = wheelset.has_caliper + p.uses_hysteresis
    wheelset.computed_force = select(modelled > 0.0, hysteretic, linear)


def follow_tanks(wheelsets: Sequence[Wheelset], line: float, p: Parameters) -> None:
    """Advance the modelled air by one base step, before the rig itself is stepped: compensation `thermal`.

    For a tank it models the air that a caliper's module would hold. It knows what the rig's computer
    knows: the readings of the tank's and the brake line's pressure, and how far the valves are open. The
    first module always has a caliper; nothing reads modelled air of a module with a caliper.
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


def start_disc(wheelset: Wheelset, p: Parameters) -> None:
    """Set the discs of a wheelset to one temperature throughout, and the friction of its pads."""
    wheelset.pad_friction = wheelset.reference_pad_friction
    wheelset.disc_temperature = p.initial_disc_temperature
    wheelset.disc_surface_temperature = p.initial_disc_temperature


def set_pad_friction(wheelsets: Sequence[Wheelset], p: Parameters) -> None:
    """Set the friction of the pads for this cycle: that of the reference point times three factors.

    The temperature is that of the friction surface, in which the pad's friction arises and which rubbing
    thermocouples measure on a test bench.
    """
    if p.varies_pad_friction > 0.0:
        for i in range(4):
            wheelset = wheelsets[i]
            at_speed = _speed_factor(p.disc_radius * abs(wheelset.rotation), p)
            under_force = _force_factor(wheelset.clamping_force, p)
            hot = interpolated(
                wheelset.disc_surface_temperature,
                p.pad_temperatures,
                p.pad_temperature_factors,
                p.pad_temperature_points,
            )
            wheelset.pad_friction = wheelset.reference_pad_friction * at_speed * under_force * hot


def _speed_factor(speed: float, p: Parameters) -> float:
    """Factor at a speed of the friction surface in m/s; a pad has a table or a quotient, the other is 1."""
    of_table = interpolated(speed, p.pad_speeds, p.pad_speed_factors, p.pad_speed_points)
    return of_table * quotient_factor(
        speed, p.pad_speed_numerator, p.pad_speed_denominator, p.pad_speed_scale
    )


def _force_factor(force: float, p: Parameters) -> float:
    """Factor under a clamping force of one pad in N; a pad has a table or a quotient, the other is 1."""
    of_table = interpolated(force, p.pad_forces, p.pad_force_factors, p.pad_force_points)
    return of_table * quotient_factor(
        force, p.pad_force_numerator, p.pad_force_denominator, p.pad_force_scale
    )


def warm_discs(wheelsets: Sequence[Wheelset], p: Parameters) -> None:
    """Warm the discs of all wheelsets by what their pads gave off in this cycle, and cool them.

    Where the temperature is not modelled the coefficients are zero: it stays as it is.
    """
    for i in range(4):
        warm_disc(wheelsets[i], p)


def warm_disc(wheelset: Wheelset, p: Parameters) -> None:
    """Advance the temperatures of one wheelset's discs to the end of a controller cycle."""
    heat = wheelset.brake_heat - wheelset.disc_heat
    change = bulk_change(
        wheelset.disc_temperature, p.air_temperature, heat, p.disc_warming, p.disc_relaxation
    )
    wheelset.disc_heat = wheelset.brake_heat
    wheelset.disc_cooling += cooled_heat(
        wheelset.disc_temperature,
        p.air_temperature,
        heat,
        p.disc_heat_capacity,
        p.disc_warming,
        p.disc_relaxation,
    )
    wheelset.disc_temperature += change
    _follow_modes(wheelset, heat, p)
    modes = (wheelset.disc_mode_1 + wheelset.disc_mode_2) + (wheelset.disc_mode_3 + wheelset.disc_mode_4)
    modes += wheelset.disc_mode_5 + wheelset.disc_mode_6
    wheelset.disc_surface_temperature = wheelset.disc_temperature + (modes + p.disc_held_rise * heat)


def _follow_modes(wheelset: Wheelset, heat: float, p: Parameters) -> None:
    wheelset.disc_mode_1 = mode_after(wheelset.disc_mode_1, heat, p.disc_rise_1, p.disc_relaxation_1)
    wheelset.disc_mode_2 = mode_after(wheelset.disc_mode_2, heat, p.disc_rise_2, p.disc_relaxation_2)
    wheelset.disc_mode_3 = mode_after(wheelset.disc_mode_3, heat, p.disc_rise_3, p.disc_relaxation_3)
    wheelset.disc_mode_4 = mode_after(wheelset.disc_mode_4, heat, p.disc_rise_4, p.disc_relaxation_4)
    wheelset.disc_mode_5 = mode_after(wheelset.disc_mode_5, heat, p.disc_rise_5, p.disc_relaxation_5)
    wheelset.disc_mode_6 = mode_after(wheelset.disc_mode_6, heat, p.disc_rise_6, p.disc_relaxation_6)
