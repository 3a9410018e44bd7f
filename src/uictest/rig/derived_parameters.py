"""Parameters that follow from several values of a scenario, or from one and a formula.

Each function states the keys of the scenario at or below which it reads; where none of them differs between
two cases, neither does what it sets. It sets fields of the parameters and reads only those it has set.
"""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from uictest.core.ensemble import case_by_case
from uictest.core.physics import MOST_COMMANDS, REFERENCE_DENSITY, coldness, orifice_law, stiffnesses
from uictest.core.units import STANDARD_GRAVITY
from uictest.plans.scenario import (
    COMPENSATION_SETTINGS,
    FIT_KEYS,
    WHEELSET_NUMBERS,
    Scenario,
    load_share,
    misfit,
    rig_differences,
    wheelset_value,
)
from uictest.rig.highest_creep import resampled_transfer_function
from uictest.rig.model.parameters import Parameters

_WHEELS = 8.0

_OF_COMMAND = (
    *("brake.command", "brake.position", "brake.system.positions", "brake.system.load_valve"),
    *("vehicle.load", "vehicle.payload"),
)

Set = Callable[[Parameters, Scenario], None]


class Assignment(NamedTuple):
    """What sets some fields of the parameters, and the keys of the scenario that it reads."""

    apply: Callable[[Any, Scenario], None]
    keys: tuple[str, ...]


DERIVED: list[Assignment] = []
"""What sets the derived parameters: the functions of this module."""


def _reads(*keys: str) -> Callable[[Set], Set]:
    """Register a function and the keys at or below which it reads."""

    def register(function: Set) -> Set:
        DERIVED.append(Assignment(function, keys))
        return function

    return register


@_reads("simulation.time_step", "simulation.maximum_duration", "controller.cycle_time")
def _cycles(p: Parameters, scenario: Scenario) -> None:
    cycle = float(scenario.controller.cycle_time)
    p.steps_per_cycle = round(cycle / float(scenario.simulation.time_step))
    p.cycles = math.ceil(scenario.simulation.maximum_duration / cycle - 1e-9)


@_reads("rig.topology", "rig.compensation", "rig.wsp")
def _topology(p: Parameters, scenario: Scenario) -> None:
    rig = scenario.rig
    p.calipers = 4 if rig.topology == "four-caliper" else 1
    setting = COMPENSATION_SETTINGS[rig.compensation]
    p.uses_cylinder_dynamics = float(setting.pressure == "filter")
    p.uses_module_air = float(setting.pressure == "air")
    p.uses_hysteresis = float(setting.hysteresis)
    p.wsp_active = int(rig.wsp == "active")


@_reads(*FIT_KEYS)
def _compensation_fit(p: Parameters, scenario: Scenario) -> None:
    differences = rig_differences(scenario)
    p.compensation_misfit = math.nan if differences is None else misfit(differences, np.maximum)


@_reads(*_OF_COMMAND)
def _command(p: Parameters, scenario: Scenario) -> None:
    _, share, name = scenario.brake.commands[0]
    position = scenario.brake.system.positions[name]
    load = load_share(scenario.brake.system.load_valve, scenario.vehicle)
    p.first_command = share
    p.commanded_pressure = share * (position.maximum_pressure * load)
    p.demand_per_pressure = 1.0 / (scenario.brake.highest_full_pressure * load)
    p.dead_time = position.dead_time
    p.filling_rate = 1.0 / position.fill_time


@_reads(*_OF_COMMAND)
def _course(p: Parameters, scenario: Scenario) -> None:
    p.command_count = len(scenario.brake.commands)
    given, shares, times, pressures, rates, releases = [], [], [], [], [], []
    for at, share, name in scenario.brake.commands if p.command_count > 1 else ():
        position = scenario.brake.system.positions[name]
        full = position.maximum_pressure * load_share(scenario.brake.system.load_valve, scenario.vehicle)
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


@_reads("until", "drag")
def _end(p: Parameters, scenario: Scenario) -> None:
    p.end_speed = 0.0 if scenario.until is None else scenario.until
    p.drag_duration = p.drag_speed = 0.0
    if scenario.drag is not None:
        p.drag_duration, p.drag_speed = scenario.drag.duration, scenario.drag.speed


@_reads()
def _addresses(p: Parameters, scenario: Scenario) -> None:
    """No controller from outside is open yet."""
    p.controller_step = p.controller_handle = p.controller_exchange = 0


@_reads("brake.system")
def _supply(p: Parameters, scenario: Scenario) -> None:
    system = scenario.brake.system
    atmosphere = system.air.atmospheric_pressure
    p.reservoir_stiffness = system.air.gas_constant * system.air.temperature / system.reservoir.volume
    p.reservoir_pressure = system.reservoir.initial_pressure + atmosphere
    p.compressor_cut_in = system.compressor.cut_in_pressure + atmosphere
    p.compressor_cut_out = system.compressor.cut_out_pressure + atmosphere


@_reads("brake.system.critical_pressure_ratio", "brake.system.laminar_pressure_ratio")
def _orifices(p: Parameters, scenario: Scenario) -> None:
    system = scenario.brake.system
    p.critical_ratio, p.subsonic_scale, p.laminar_slope = case_by_case(
        orifice_law, system.critical_pressure_ratio, system.laminar_pressure_ratio
    )


@_reads("brake.system.air")
def _air(p: Parameters, scenario: Scenario) -> None:
    air = scenario.brake.system.air
    p.heat_capacity_volume = air.gas_constant / (air.heat_capacity_ratio - 1.0)
    p.heat_capacity_pressure = air.heat_capacity_ratio * p.heat_capacity_volume
    p.air_coldness = coldness(air.temperature)


@_reads("brake.system.caliper_tank", "brake.system.tank")
def _caliper_tank(p: Parameters, scenario: Scenario) -> None:
    system = scenario.brake.system
    dead = system.caliper_tank.hose_and_dead_volume - system.caliper_tank.ball_volume
    p.caliper_tank_volume = system.tank.volume + dead


@_reads("brake.system.caliper_tank", "brake.system.tank", "brake.system.brake_line", "simulation.time_step")
def _walls(p: Parameters, scenario: Scenario) -> None:
    """Heat conductances of the walls, h A, times the step."""
    system = scenario.brake.system
    step = float(scenario.simulation.time_step)
    line, tank, balls = system.brake_line, system.tank, system.caliper_tank
    p.line_exchange = step * line.film_coefficient * line.surface
    p.tank_exchange = step * tank.film_coefficient * tank.surface
    p.caliper_tank_exchange = p.tank_exchange + step * balls.film_coefficient * balls.ball_surface


@_reads("rig.caliper", "simulation.time_step")
def _caliper(p: Parameters, scenario: Scenario) -> None:
    caliper = scenario.rig.caliper
    p.piston_damping, p.contact_damping, _, _, p.free_compliance, _, _ = case_by_case(
        stiffnesses,
        caliper.spring_rate,
        caliper.load_friction,
        caliper.viscous_friction,
        caliper.contact_friction,
        caliper.contact_stiffness,
        scenario.simulation.time_step,
    )


@_reads("rig.compensation_model.cylinder", "rig.compensation_model.sampling_time", "simulation.time_step")
def _cylinder(p: Parameters, scenario: Scenario) -> None:
    model = scenario.rig.compensation_model
    numerator, denominator = resampled_transfer_function(
        [float(b) for b in model.cylinder.numerator],
        [float(a) for a in model.cylinder.denominator],
        float(model.sampling_time),
        float(scenario.simulation.time_step),
    )
    p.b0, p.b1, p.b2, p.b3 = numerator
    p.a1, p.a2, p.a3 = denominator


@_reads(
    "rig.compensation_model.air",
    *("brake.system.air", "brake.system.tank", "brake.system.wsp_valve"),
    "simulation.time_step",
)
def _module_air(p: Parameters, scenario: Scenario) -> None:
    """Numbers of :mod:`uictest.core.physics.air`."""
    model, system = scenario.rig.compensation_model.air, scenario.brake.system
    step, atmosphere = float(scenario.simulation.time_step), system.air.atmospheric_pressure
    heating = step * (system.air.heat_capacity_ratio - 1.0) * system.air.temperature / system.tank.volume
    filling = step * system.air.gas_constant * system.air.temperature * REFERENCE_DENSITY / system.tank.volume
    p.modelled_tank_exchange = heating * model.tank_heat_conductance
    p.modelled_exchange = heating * model.caliper_heat_conductance
    p.modelled_fill_conductance = filling * system.wsp_valve.fill_conductance
    p.modelled_vent_conductance = filling * system.wsp_valve.vent_conductance
    p.modelled_swept_share = model.swept_volume / system.tank.volume
    p.modelled_closing_pressure = model.closing_pressure + atmosphere
    p.modelled_opening_pressure = model.opening_pressure + atmosphere


@_reads("rig.compensation_model.hysteresis", "simulation.time_step", "controller.cycle_time")
def _hysteresis(p: Parameters, scenario: Scenario) -> None:
    hysteresis = scenario.rig.compensation_model.hysteresis
    step = float(scenario.simulation.time_step)
    p.phase_change_per_step = min(step / max(float(hysteresis.transition_time), step), 1.0)
    p.wsp_acting_cycles = round(hysteresis.wsp_acting_time / scenario.controller.cycle_time)


@_reads("vehicle.body", "vehicle.bogie", "vehicle.load", "vehicle.payload", "simulation.time_step")
def _frames(p: Parameters, scenario: Scenario) -> None:
    """What a force or moment on the car body or a bogie changes within one step."""
    body, bogie = scenario.vehicle.loaded_body, scenario.vehicle.bogie
    step = float(scenario.simulation.time_step)
    p.body_mass, p.body_inertia = body.mass, body.pitch_inertia
    p.body_mass_rate = body.mass / step
    p.body_mass_response = step / body.mass
    p.body_pitch_response = step / body.pitch_inertia
    p.bogie_mass_response = step / bogie.mass
    p.bogie_pitch_response = step / bogie.pitch_inertia


@_reads("vehicle.wheelset.mass", "simulation.time_step")
def _wheelset(p: Parameters, scenario: Scenario) -> None:
    """What a force on a wheelset changes within one step."""
    p.mass_response = float(scenario.simulation.time_step) / scenario.vehicle.wheelset.mass


@_reads("vehicle")
def _weight(p: Parameters, scenario: Scenario) -> None:
    p.gravity = STANDARD_GRAVITY
    p.total_mass = scenario.vehicle.total_mass
    p.static_wheel_load = scenario.vehicle.total_mass * STANDARD_GRAVITY / _WHEELS


@_reads("rail.condition.contact")
def _contact(p: Parameters, scenario: Scenario) -> None:
    p.creep_stiffness = scenario.rail.condition.contact.creep_stiffness


@_reads("rig.sensors.train_speed", "rig.sensors.acceleration", "controller.cycle_time")
def _train_sensors(p: Parameters, scenario: Scenario) -> None:
    speed, acceleration = scenario.rig.sensors.train_speed, scenario.rig.sensors.acceleration
    cycle = float(scenario.controller.cycle_time)
    p.has_train_speed, p.has_accelerometer = float(speed is not None), float(acceleration is not None)
    p.train_speed_period = p.train_speed_delay = 0
    p.train_speed_noise = p.train_speed_gain_error = p.accelerometer_noise = p.accelerometer_offset = 0.0
    if speed is not None:
        p.train_speed_period = max(round(speed.period / cycle), 1)
        p.train_speed_delay = min(round(speed.delay / cycle), 3 * p.train_speed_period)
        p.train_speed_noise, p.train_speed_gain_error = speed.noise, speed.gain_error
    if acceleration is not None:
        p.accelerometer_noise, p.accelerometer_offset = acceleration.noise, acceleration.offset


@_reads("rig.sensors.speed", "vehicle.wheelsets")
def _pole_wheels(p: Parameters, scenario: Scenario) -> None:
    def differs(number: int) -> bool:
        method = wheelset_value(scenario, number, "sensors.speed.method")
        eccentricity = float(wheelset_value(scenario, number, "sensors.speed.eccentricity"))
        return method != "momentary" or eccentricity > 0.0

    p.uses_pole_wheels = float(any(map(differs, WHEELSET_NUMBERS)))
