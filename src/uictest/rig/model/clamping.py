"""From the pressure of a module to its clamping force: the real caliper, or what replaces it."""

from uictest.core.physics import (
    analogue_reading,
    beyond_range,
    clamping_force,
    fma,
    force_after,
    line,
    memory,
    output,
    phase_share,
    select,
    stroke_after,
)
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.state import Wheelset


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
    """Turn cylinder pressure into force, by the four lines or by a single one."""
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
