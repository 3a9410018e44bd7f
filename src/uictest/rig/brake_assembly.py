"""Parameters of brake, caliper and compensation that follow from several values, or from one and a formula.

Each function sets fields of a parameter record from what its arguments name (:mod:`uictest.rig.assembly`),
and reads no field but those that it has set.
"""

import math
from types import SimpleNamespace
from typing import Final

import numpy as np

from uictest.core.physics import (
    MODES,
    MOST_COMMANDS,
    MOST_PAD_POINTS,
    REFERENCE_DENSITY,
    coldness,
    held_mode,
    held_rest,
    mode_relaxation,
    orifice_law,
    quotient_scale,
    relaxed_share,
    stiffnesses,
    torque,
)
from uictest.plans.scenario import (
    COMPENSATION_SETTINGS,
    EMERGENCY,
    WHEELSET_NUMBERS,
    Brake,
    BrakeSystem,
    Caliper,
    CylinderDynamics,
    Disc,
    DiscRing,
    DynamicBrake,
    FourPhaseHysteresis,
    ModuleAir,
    Pad,
    PadLaw,
    Rig,
    TrackBrake,
    Vehicle,
    load_share,
    misfit,
    rig_differences,
)
from uictest.rig.model.parameters import Parameters

_BOGIES: Final = 2


def set_topology(p: Parameters, rig: Rig) -> None:
    """Set what kind of rig it is: real calipers, compensation in the other modules, WSP."""
    setting = COMPENSATION_SETTINGS[rig.compensation]
    p.calipers = 4 if rig.topology == "four-caliper" else 1
    p.uses_cylinder_dynamics = float(setting.pressure == "filter")
    p.uses_module_air = float(setting.pressure == "air")
    p.uses_hysteresis = float(setting.hysteresis)
    p.wsp_active = int(rig.wsp == "active")


def set_compensation_misfit(p: Parameters, rig: Rig, system: BrakeSystem, vehicle: Vehicle) -> None:
    """Set how far the rig is from the one that its compensation was identified for; NaN: not known."""
    parts = SimpleNamespace(rig=rig, brake=SimpleNamespace(system=system), vehicle=vehicle)
    differences = rig_differences(parts)
    p.compensation_misfit = math.nan if differences is None else misfit(differences, np.maximum)


def set_commands(p: Parameters, brake: Brake, vehicle: Vehicle) -> None:
    """Set the first brake command and, where there are several, the tables of all."""
    system, load = brake.system, load_share(brake.system.load_valve, vehicle)
    _, first_share, name = brake.commands[0]
    first = system.positions[name]
    p.first_command = first_share
    p.commanded_pressure = first_share * (first.maximum_pressure * load)
    p.demand_per_pressure = 1.0 / (brake.highest_full_pressure * load)
    p.dead_time = first.dead_time
    p.filling_rate = 1.0 / first.fill_time
    p.command_count = len(brake.commands)
    given, shares, times, pressures, rates, releases = [], [], [], [], [], []
    for at, share, name in brake.commands if p.command_count > 1 else ():
        position = system.positions[name]
        full = position.maximum_pressure * load
        release_time = position.fill_time if position.release_time is None else position.release_time
        given.append(at)
        shares.append(share)
        times.append(at + position.dead_time)
        pressures.append(share * full)
        rates.append(full / position.fill_time)
        releases.append(full / release_time)
    blank = [0.0] * (MOST_COMMANDS - len(times))
    p.command_given, p.command_shares = given + blank, shares + blank
    p.command_times, p.command_pressures = times + blank, pressures + blank
    p.command_rates, p.release_rates = rates + blank, releases + blank


def set_supply(p: Parameters, system: BrakeSystem, supply: str) -> None:
    """Set reservoir and compressor, which delivers nothing where `supply` is off."""
    atmosphere = system.air.atmospheric_pressure
    p.reservoir_stiffness = system.air.gas_constant * system.air.temperature / system.reservoir.volume
    p.reservoir_pressure = system.reservoir.initial_pressure + atmosphere
    p.compressor_cut_in = system.compressor.cut_in_pressure + atmosphere
    p.compressor_delivery = float(system.compressor.delivery) if supply == "on" else 0.0
    p.compressor_cut_out = system.compressor.cut_out_pressure + atmosphere


def set_air(p: Parameters, system: BrakeSystem) -> None:
    """Set the properties of air and of the flow through orifices."""
    air = system.air
    p.heat_capacity_volume = air.gas_constant / (air.heat_capacity_ratio - 1.0)
    p.heat_capacity_pressure = air.heat_capacity_ratio * p.heat_capacity_volume
    p.air_coldness = coldness(air.temperature)
    p.critical_ratio, p.subsonic_scale, p.laminar_slope = orifice_law(
        float(system.critical_pressure_ratio), float(system.laminar_pressure_ratio)
    )


def set_tanks(p: Parameters, system: BrakeSystem, time_step: float) -> None:
    """Set the volume of the caliper's module, and the heat conductances of the walls, h A, times the step."""
    step = float(time_step)
    line, tank, balls = system.brake_line, system.tank, system.caliper_tank
    p.caliper_tank_volume = tank.volume + (balls.hose_and_dead_volume - balls.ball_volume)
    p.line_exchange = step * line.film_coefficient * line.surface
    p.tank_exchange = step * tank.film_coefficient * tank.surface
    p.caliper_tank_exchange = p.tank_exchange + step * balls.film_coefficient * balls.ball_surface


def set_caliper(p: Parameters, caliper: Caliper, time_step: float) -> None:
    """Set what :func:`uictest.core.physics.stiffnesses` gives for all calipers."""
    p.piston_damping, p.contact_damping, _, _, p.free_compliance, _, _ = stiffnesses(
        float(caliper.spring_rate),
        float(caliper.load_friction),
        float(caliper.viscous_friction),
        float(caliper.contact_friction),
        float(caliper.contact_stiffness),
        float(time_step),
    )


def set_cylinder(
    p: Parameters, cylinder: CylinderDynamics, cylinder_sampling_time: float, time_step: float
) -> None:
    """Set the coefficients of the cylinder's transfer function at the step of the simulation."""
    numerator, denominator = resampled_transfer_function(
        [float(b) for b in cylinder.numerator],
        [float(a) for a in cylinder.denominator],
        float(cylinder_sampling_time),
        float(time_step),
    )
    p.b0, p.b1, p.b2, p.b3 = numerator
    p.a1, p.a2, p.a3 = denominator


def resampled_transfer_function(
    numerator: list[float], denominator: list[float], sampling_time: float, step: float
) -> tuple[list[float], list[float]]:
    """Coefficients that give at ``step`` the response of those given at ``sampling_time`` (both s).

    The held input that the model assumes is kept: the state matrix is taken to a fractional power and
    the input matrix follows from the same steady state. At the sampling time itself the coefficients
    are returned as they are.
    """
    if abs(step - sampling_time) < 1e-12 * sampling_time:
        return numerator, denominator
    # Scipy's `tf2ss` and `ss2tf` give the same bits; loading them takes as long as a hundred stops.
    from scipy.linalg import fractional_matrix_power

    order, through = len(denominator), numerator[0]
    identity = np.eye(order)
    a = np.vstack([np.negative(denominator), np.eye(order - 1, order)])
    b, c = identity[:, :1], np.array(numerator[1:]) - through * np.array(denominator)
    faster = np.real(fractional_matrix_power(a, step / sampling_time))
    held = (faster - identity) @ np.linalg.solve(a - identity, b)
    a_new = np.poly(faster)
    b_new = [float(x) for x in np.poly(faster - held * c) + (through - 1.0) * a_new]
    resampled = [float(x) for x in a_new[1:]]
    # Rounding the last digits of the coefficients changes the gain at rest: make it one again.
    rest = math.fsum([1.0, *resampled])
    return [math.fsum([rest, *(-x for x in b_new[1:])]), *b_new[1:]], resampled


def set_module_air(p: Parameters, modelled_air: ModuleAir, system: BrakeSystem, time_step: float) -> None:
    """Set the numbers of :mod:`uictest.core.physics.air` for the air that a caliper's module would hold."""
    step, atmosphere = float(time_step), system.air.atmospheric_pressure
    heating = step * (system.air.heat_capacity_ratio - 1.0) * system.air.temperature / system.tank.volume
    filling = step * system.air.gas_constant * system.air.temperature * REFERENCE_DENSITY / system.tank.volume
    p.modelled_tank_exchange = heating * modelled_air.tank_heat_conductance
    p.modelled_exchange = heating * modelled_air.caliper_heat_conductance
    p.modelled_fill_conductance = filling * system.wsp_valve.fill_conductance
    p.modelled_vent_conductance = filling * system.wsp_valve.vent_conductance
    p.modelled_swept_share = modelled_air.swept_volume / system.tank.volume
    p.modelled_closing_pressure = modelled_air.closing_pressure + atmosphere
    p.modelled_opening_pressure = modelled_air.opening_pressure + atmosphere


def set_hysteresis(
    p: Parameters, hysteresis: FourPhaseHysteresis, time_step: float, cycle_time: float
) -> None:
    """Set how the lines of the BC turn into those of the WSP."""
    step = float(time_step)
    p.phase_change_per_step = min(step / max(float(hysteresis.transition_time), step), 1.0)
    p.wsp_acting_cycles = round(hysteresis.wsp_acting_time / cycle_time)


def set_pad(p: Parameters, pad: Pad) -> None:
    """Set the factors of the pad friction over speed, force and temperature."""
    speed, force, temperature = (law or PadLaw() for law in (pad.speed, pad.force, pad.temperature))
    p.varies_pad_friction = float(pad.varies)
    p.pad_speed_points, p.pad_speeds, p.pad_speed_factors = _padded_table(speed)
    p.pad_force_points, p.pad_forces, p.pad_force_factors = _padded_table(force)
    p.pad_temperature_points, p.pad_temperatures, p.pad_temperature_factors = _padded_table(temperature)
    p.pad_speed_scale = quotient_scale(*speed.quotient)
    p.pad_force_scale = quotient_scale(*force.quotient)
    _, p.pad_speed_numerator, p.pad_speed_denominator = speed.quotient
    _, p.pad_force_numerator, p.pad_force_denominator = force.quotient


def _padded_table(law: PadLaw) -> tuple[int, list[float], list[float]]:
    """Return number, arguments and factors of the points of a table, as long as the record's tables."""
    arguments, factors = zip(*law.table, strict=True)
    blank = [0.0] * (MOST_PAD_POINTS - len(arguments))
    return len(arguments), [*arguments, *blank], [*factors, *blank]


def set_discs(p: Parameters, brake: Brake, cycle_time: float) -> None:
    """Set the coefficients of a controller cycle; all zero where the temperature stays as it is."""
    initial, disc = brake.initial_disc_temperature, brake.system.disc
    p.initial_disc_temperature = brake.system.air.temperature if initial is None else initial
    p.models_disc_temperature = float(brake.models_disc_temperature)
    p.disc_heat_capacity = p.disc_warming = p.disc_relaxation = p.disc_held_rise = 0.0
    for number in range(1, MODES + 1):
        setattr(p, f"disc_rise_{number}", 0.0)
        setattr(p, f"disc_relaxation_{number}", 0.0)
    if brake.models_disc_temperature and disc.thermal is not None:
        faces = float(disc.calipers_per_wheelset * disc.pads_per_caliper)
        _set_warming(p, disc.thermal, faces, float(cycle_time))


def _set_warming(p: Parameters, ring: DiscRing, faces: float, cycle: float) -> None:
    capacity = faces * ring.density * ring.specific_heat * ring.area * ring.thickness
    time_constants = cycle * faces * ring.film_coefficient * ring.area / capacity
    p.disc_heat_capacity = capacity
    p.disc_relaxation = relaxed_share(time_constants)
    p.disc_warming = (p.disc_relaxation / time_constants if time_constants > 0.0 else 1.0) / capacity
    held = ring.thickness / ring.conductivity / (faces * ring.area * cycle)  # q L / k of 1 J in a cycle
    fourier = ring.conductivity * cycle / (ring.density * ring.specific_heat * ring.thickness**2)
    p.disc_held_rise = held * held_rest()
    for number in range(1, MODES + 1):
        relaxation = mode_relaxation(number, fourier)
        setattr(p, f"disc_rise_{number}", held * held_mode(number) * relaxation)
        setattr(p, f"disc_relaxation_{number}", relaxation)


def set_motors(p: Parameters, motors: DynamicBrake | None, cycle_time: float) -> None:
    """Set the dynamic brake; all zero without one."""
    p.has_dynamic_brake = float(motors is not None)
    p.motor_forces = p.motor_powers = [0.0] * len(WHEELSET_NUMBERS)
    p.fade_end = p.fade_rate = p.motor_response = 0.0
    if motors is not None:
        p.motor_forces = _shares_of_wheelsets(float(motors.force), motors)
        p.motor_powers = _shares_of_wheelsets(float(motors.power), motors)
        begin, p.fade_end = map(float, motors.fade_out)
        p.fade_rate = 1.0 / (begin - p.fade_end)
        cycles = float(motors.response_time) / float(cycle_time)
        p.motor_response = -math.expm1(-1.0 / cycles)


def _shares_of_wheelsets(whole: float, motors: DynamicBrake) -> list[float]:
    """Return the share of each wheelset in a total that the motored ones share."""
    share = whole / len(motors.wheelsets)
    return [share if number in motors.wheelsets else 0.0 for number in WHEELSET_NUMBERS]


def set_blending(
    p: Parameters, motors: DynamicBrake | None, caliper: Caliper, disc: Disc, regular_radius: float
) -> None:
    """Set what the blending knows of the regular friction brake of the car; all zero without a dynamic brake.

    That is the pressure at which the pads of the squeezing caliper touch the disc, the force at the rims of
    four regular wheelsets above it, and the width of the caliper's loop.
    """
    p.zero_force_pressure = p.force_per_pressure = p.coulomb_width = p.load_width = 0.0
    if motors is not None:
        clamping = caliper.lever_ratio * caliper.piston_area / (1.0 + caliper.load_friction)
        faces = disc.calipers_per_wheelset, disc.pads_per_caliper
        braking = torque(clamping, *faces, disc.pad_friction, disc.mean_radius)
        p.zero_force_pressure = caliper.closing_force / caliper.piston_area
        p.force_per_pressure = len(WHEELSET_NUMBERS) * braking / regular_radius
        p.coulomb_width = 2.0 * caliper.coulomb_friction / caliper.piston_area
        p.load_width = 2.0 * caliper.load_friction / (1.0 + caliper.load_friction)


_SLOWEST_MAGNET: Final = 0.01
"""m/s: friction of the magnets is whole from there on where the step permits; chosen."""
_STABLE: Final = 0.5
"""Share of a bogie's speed that the magnets may take in a step at most: half of what never overshoots."""


def set_magnets(
    p: Parameters, track_brake: TrackBrake | None, vehicle: Vehicle, time_step: float, cycle_time: float
) -> None:
    """Set the force of the track brake; without one no force, and no division by zero."""
    p.has_track_brake = float(track_brake is not None)
    p.magnet_attraction = p.magnet_friction = p.magnet_cleaning = 0.0
    p.magnet_numerator = p.magnet_denominator = p.magnet_slowest = p.magnet_change = 1.0
    if track_brake is not None:
        p.magnet_attraction = track_brake.attraction * track_brake.magnets / _BOGIES
        p.magnet_friction, p.magnet_cleaning = track_brake.friction, track_brake.cleaning
        p.magnet_numerator, p.magnet_denominator = track_brake.friction_speeds
        p.magnet_change = min(cycle_time / track_brake.rise_time, 1.0)
        height = vehicle.traction_link.height - vehicle.bogie.height
        response = 1.0 / vehicle.bogie.mass + height**2 / vehicle.bogie.pitch_inertia
        change = time_step * response * track_brake.largest_force / _BOGIES
        p.magnet_slowest = max(_SLOWEST_MAGNET, change / _STABLE)


def set_track_brake_commands(p: Parameters, brake: Brake) -> None:
    """Set with which commands, on whose request and how soon the track brake acts."""
    track_brake = brake.track
    p.track_brake_first = p.track_brake_delay = p.track_brake_off_speed = p.track_brake_requested = 0.0
    p.track_brake_commands = [0.0] * MOST_COMMANDS
    if track_brake is not None:
        p.track_brake_delay = track_brake.delay
        p.track_brake_off_speed = 0.0 if track_brake.off_below is None else track_brake.off_below
        p.track_brake_requested = float(track_brake.when == "requested")
        for k, (_, share, position) in enumerate(brake.commands):
            serves = track_brake.when != EMERGENCY or position == EMERGENCY
            p.track_brake_commands[k] = float(share > 0.0 and serves)


BRAKE: Final = (
    *(set_topology, set_compensation_misfit, set_commands, set_supply, set_air, set_tanks, set_caliper),
    *(set_cylinder, set_module_air, set_hysteresis, set_pad, set_discs, set_motors, set_blending),
    *(set_magnets, set_track_brake_commands),
)
"""What sets parameters of the brake."""
