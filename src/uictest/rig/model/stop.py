"""One stop, from the brake command, when the train rolls with its brakes released, to standstill."""

from collections.abc import Sequence
from typing import Any

from uictest.controllers import NO_FAILURE
from uictest.core.measures import StopMeasures, WheelsetMeasures
from uictest.core.physics import select
from uictest.rig.model.balance import stored_air, stored_air_energy, stored_energy
from uictest.rig.model.brake_command import follow_commands, start_command
from uictest.rig.model.controller import FROM_OUTSIDE, begin, decide, read_outputs, write_inputs
from uictest.rig.model.cycle import command_valves, read_pole_wheels, read_sensors, start_cycle
from uictest.rig.model.disc_brake import start_disc, warm_discs
from uictest.rig.model.dynamic_brake import (
    brake_dynamically,
    demand_dynamic_brake,
    start_dynamic_brake,
)
from uictest.rig.model.faults import (
    falsify_readings,
    let_air_leak,
    limit_valves,
    silence_controller,
    update_faults,
)
from uictest.rig.model.module_air import follow_module_air
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.rail import RailMemory, clean_rail, forget_rail, set_creep_curve
from uictest.rig.model.state import Bogie, Car, Wheelset
from uictest.rig.model.step import step
from uictest.rig.model.stop_measures import (
    begin_stop_measures,
    begin_tables,
    close_stop_measures,
    keep_tables,
    observe_cycle,
    observe_faults,
)
from uictest.rig.model.trace import Trace, sample
from uictest.rig.model.traction import hold_speed
from uictest.rig.model.wheelset_parameters import WheelsetParameters, copy_wheelset_parameters

LONG_AGO = 1_000_000
"""Cycles of uninterrupted filling that stand for "the WSP has not acted yet"."""


def start(
    car: Car,
    bogies: Sequence[Bogie],
    wheelsets: Sequence[Wheelset],
    p: Parameters,
    wheelset_parameters: Sequence[WheelsetParameters],
) -> None:
    """Set the state of zeroed records for a stop from ``p.initial_speed``."""
    car.speed = p.initial_speed
    start_supply(car, p)
    start_command(car, p)
    for j in range(2):
        bogies[j].speed = p.initial_speed
        bogies[j].ahead = p.half_pivot_distance * (1.0 - 2.0 * j)
    for i in range(4):
        side = 1.0 - 2.0 * (i % 2)
        bogie = bogies[i // 2]
        copy_wheelset_parameters(wheelsets[i], wheelset_parameters[i])
        _start_wheelset(wheelsets[i], p)
        start_disc(wheelsets[i], p)
        start_dynamic_brake(wheelsets[i], i, p)
        set_creep_curve(wheelsets[i], p)
        start_module(wheelsets[i], select(i < p.calipers, 1.0, 0.0), p)
        wheelsets[i].ahead = side * p.half_wheelbase
        wheelsets[i].behind = p.half_pivot_distance - bogie.ahead + p.half_wheelbase * (1.0 - side)
    car.axle_load = 2.0 * p.static_wheel_load
    begin(car, wheelsets, p)
    car.initial_energy = stored_energy(car, bogies, wheelsets, p)
    car.initial_air = stored_air(car, wheelsets)
    car.initial_air_energy = stored_air_energy(car, wheelsets, p)


def start_supply(car: Car, p: Parameters) -> None:
    """Fill the reservoir; the brake line is empty."""
    car.reservoir_pressure = p.reservoir_pressure
    car.line_pressure = p.atmospheric_pressure
    car.line_temperature = p.air_temperature
    car.line_coldness = p.air_coldness
    car.reservoir_mass = p.reservoir_pressure * p.reservoir_volume / (p.gas_constant * p.air_temperature)
    car.line_mass = p.atmospheric_pressure * p.line_volume / (p.gas_constant * p.air_temperature)


def _start_wheelset(wheelset: Wheelset, p: Parameters) -> None:
    wheelset.speed = p.initial_speed
    wheelset.rotation = p.initial_speed / wheelset.wheel_radius
    wheelset.wheel_load = p.static_wheel_load
    wheelset.speed_valid = 1
    wheelset.held_speed = p.initial_speed


def start_module(wheelset: Wheelset, has_caliper: float, p: Parameters) -> None:
    """Let the valve of a module fill from the empty brake line into its empty tank."""
    volume = select(has_caliper > 0.0, p.caliper_tank_volume, p.tank_volume)
    wheelset.has_caliper = has_caliper
    wheelset.filling_cycles = LONG_AGO
    wheelset.fill_opening = 1.0
    wheelset.pressure = p.atmospheric_pressure
    wheelset.air_temperature = p.air_temperature
    wheelset.air_coldness = p.air_coldness
    wheelset.air_mass = p.atmospheric_pressure * volume / (p.gas_constant * p.air_temperature)
    wheelset.modelled_tank_pressure = p.atmospheric_pressure
    wheelset.modelled_tank_air = p.atmospheric_pressure
    wheelset.modelled_pressure = p.atmospheric_pressure
    wheelset.modelled_volume = 1.0 - p.modelled_swept_share
    wheelset.modelled_air = p.atmospheric_pressure * wheelset.modelled_volume
    wheelset.pressure_ratio = 1.0


def run_stop(
    car: Car,
    bogies: Sequence[Bogie],
    wheelsets: Sequence[Wheelset],
    p: Parameters,
    wheelset_parameters: Sequence[WheelsetParameters],
    rail: Any,
    memory: RailMemory,
    measures: StopMeasures,
    wheelset_measures: Sequence[WheelsetMeasures],
    trace: Trace,
    steps_per_sample: int,
) -> int:
    """Run one stop on zeroed records, fill the measures and return the number of rows written to ``trace``.

    Steps run in whole controller cycles. Standstill is interpolated within the step and the cycle is
    finished, so that a stop runs the same steps alone or beside others. ``trace`` has a row for every
    ``steps_per_sample`` steps; with 0 nothing is recorded. Recording reads the state and never changes it.
    """
    begin_stop(car, bogies, wheelsets, p, wheelset_parameters, memory, measures, wheelset_measures)
    rows = 0
    while is_running(car, p):
        begin_cycle(car, wheelsets, p, wheelset_parameters, rail, memory)
        decide(car, wheelsets, p)
        rows = finish_cycle(
            car, bogies, wheelsets, p, measures, wheelset_measures, trace, steps_per_sample, rows
        )
    close_stop_measures(car, bogies, wheelsets, measures, wheelset_measures, p)
    return rows


def is_running(car: Car, p: Parameters) -> bool:
    """Whether the stop goes on for another controller cycle."""
    return car.stopped == 0.0 and car.cycle < p.cycles and car.controller_failed == 0


def begin_stop(
    car: Car,
    bogies: Sequence[Bogie],
    wheelsets: Sequence[Wheelset],
    p: Parameters,
    wheelset_parameters: Sequence[WheelsetParameters],
    memory: RailMemory,
    measures: StopMeasures,
    wheelset_measures: Sequence[WheelsetMeasures],
) -> None:
    """Set zeroed records to the instant of the brake command."""
    start(car, bogies, wheelsets, p, wheelset_parameters)
    begin_stop_measures(car, measures, wheelset_measures, p)
    begin_tables(measures, wheelset_measures)
    if p.cleans_rail > 0.0:
        forget_rail(memory, p)


def begin_cycle(
    car: Car,
    wheelsets: Sequence[Wheelset],
    p: Parameters,
    wheelset_parameters: Sequence[WheelsetParameters],
    rail: Any,
    memory: RailMemory,
) -> None:
    """Do what comes before the controller decides: read the sensors, look up friction, clean the rail."""
    if p.fault_count > 0:
        update_faults(car, wheelsets, p, wheelset_parameters)
    read_sensors(car, wheelsets, p)
    if p.uses_pole_wheels > 0.0:
        read_pole_wheels(car, wheelsets, p)
    start_cycle(car, wheelsets, p, rail)
    if p.cleans_rail > 0.0:
        clean_rail(car, wheelsets, p, memory)
    if p.fault_count > 0:
        falsify_readings(car, wheelsets, p)


def finish_cycle(
    car: Car,
    bogies: Sequence[Bogie],
    wheelsets: Sequence[Wheelset],
    p: Parameters,
    measures: StopMeasures,
    wheelset_measures: Sequence[WheelsetMeasures],
    trace: Trace,
    steps_per_sample: int,
    rows: int,
) -> int:
    """Carry out what the controller has decided; return the number of rows that the trace has then."""
    steps = car.cycle * p.steps_per_cycle
    act(car, wheelsets, p, measures)
    if steps_per_sample > 0 and rows == 0:
        sample(trace, 0, car, wheelsets, p)
        rows = 1
    for _ in range(p.steps_per_cycle):
        advance(car, bogies, wheelsets, p)
        steps += 1
        if steps_per_sample > 0 and steps % steps_per_sample == 0:
            sample(trace, rows, car, wheelsets, p)
            rows += 1
    end_cycle(car, wheelsets, p, measures, wheelset_measures)
    return rows


def act(car: Car, wheelsets: Sequence[Wheelset], p: Parameters, measures: StopMeasures) -> None:
    """Set valves and demands for a cycle by what the controller has decided and the driver commands."""
    if p.fault_count > 0:
        silence_controller(car, wheelsets, p)
    command_valves(car, wheelsets, p)
    if p.command_count > 1:
        follow_commands(car, measures, p)
    if p.drag_duration > 0.0:
        hold_speed(car, p)
    if p.has_dynamic_brake > 0.0:
        demand_dynamic_brake(car, wheelsets, p)
    if p.fault_count > 0:
        limit_valves(car, wheelsets, p)


def advance(car: Car, bogies: Sequence[Bogie], wheelsets: Sequence[Wheelset], p: Parameters) -> None:
    """Step a car, with what only some scenarios have."""
    if p.uses_module_air > 0.0:
        follow_module_air(car, wheelsets, p)
    if p.has_leaks > 0.0:
        let_air_leak(car, wheelsets, p)
    if p.has_dynamic_brake > 0.0:
        brake_dynamically(wheelsets, p)
    step(car, bogies, wheelsets, p)


def end_cycle(
    car: Car,
    wheelsets: Sequence[Wheelset],
    p: Parameters,
    measures: StopMeasures,
    wheelset_measures: Sequence[WheelsetMeasures],
) -> None:
    """Do what comes after the steps of a cycle: warm the discs, feed the measures."""
    if p.models_disc_temperature > 0.0:
        warm_discs(wheelsets, p)
    observe_cycle(car, wheelsets, measures, wheelset_measures, p)
    if p.fault_count > 0:
        observe_faults(car, wheelsets, measures, wheelset_measures, p)
    keep_tables(measures, wheelset_measures, measures, wheelset_measures, p)


def step_stop(
    car: Car,
    bogies: Sequence[Bogie],
    wheelsets: Sequence[Wheelset],
    p: Parameters,
    wheelset_parameters: Sequence[WheelsetParameters],
    rail: Any,
    memory: RailMemory,
    measures: StopMeasures,
    wheelset_measures: Sequence[WheelsetMeasures],
    exchange: Any,
    present: Trace,
    trace: Trace,
    steps_per_sample: int,
    rows: int,
) -> int:
    """Carry out the commands in the exchange for one cycle; on zeroed records, begin the stop instead.

    Afterwards the exchange holds what the sensors show then, and ``present``, a trace of one row, the true
    state. A command that no valve has is only reported in ``exchange.failure``. Returns the number of rows
    that ``trace`` has.
    """
    if exchange.cycles == 0:
        p.controller = FROM_OUTSIDE  # whatever the case names: whoever carries the stop on decides
        begin_stop(car, bogies, wheelsets, p, wheelset_parameters, memory, measures, wheelset_measures)
    else:
        exchange.failure = NO_FAILURE
        read_outputs(exchange, car, wheelsets, p)
        if exchange.failure != NO_FAILURE:
            return rows
        rows = finish_cycle(
            car, bogies, wheelsets, p, measures, wheelset_measures, trace, steps_per_sample, rows
        )
        if not is_running(car, p):
            close_stop_measures(car, bogies, wheelsets, measures, wheelset_measures, p)
    # Also at the end: whoever drives the rig sees the sensors at standstill. No measure is taken from this.
    begin_cycle(car, wheelsets, p, wheelset_parameters, rail, memory)
    write_inputs(exchange, car, wheelsets, p)
    exchange.cycles += 1
    sample(present, 0, car, wheelsets, p)
    return rows
