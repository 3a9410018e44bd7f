"""One stop, from the brake command, when the train rolls with its brakes released, to standstill."""

from collections.abc import Sequence
from typing import Any

from uictest.controllers import NO_FAILURE
from uictest.core.measures import StopMeasures, WheelsetMeasures
from uictest.rig.model.brake_command import follow_commands
from uictest.rig.model.controller import FROM_OUTSIDE, decide, read_outputs, write_inputs
from uictest.rig.model.cycle import command_valves, read_pole_wheels, read_sensors, start_cycle
from uictest.rig.model.disc_brake import warm_discs
from uictest.rig.model.dynamic_brake import brake_dynamically, demand_dynamic_brake
from uictest.rig.model.faults import (
    falsify_readings,
    let_air_leak,
    limit_valves,
    silence_controller,
    update_faults,
)
from uictest.rig.model.module_air import follow_tanks, read_line_pressure
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.rail import RailMemory, clean_rail, forget_rail
from uictest.rig.model.sand import command_sanders, forget_sand, spread_sand
from uictest.rig.model.start import start
from uictest.rig.model.state import Bogie, Car, Wheelset
from uictest.rig.model.step import step
from uictest.rig.model.stop_measures import (
    begin_stop_measures,
    begin_tables,
    close_stop_measures,
    keep_tables,
    observe_cycle,
    observe_faults,
    observe_reports,
)
from uictest.rig.model.trace import Trace, sample
from uictest.rig.model.track_brake import (
    account_for_magnets,
    clean_by_magnets,
    command_track_brake,
    drag_magnets,
)
from uictest.rig.model.traction import hold_speed
from uictest.rig.model.train_sensors import read_train_sensors
from uictest.rig.model.wheelset_parameters import WheelsetParameters


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
    if p.has_sanders > 0.0:
        forget_sand(memory)


def begin_cycle(
    car: Car,
    wheelsets: Sequence[Wheelset],
    p: Parameters,
    wheelset_parameters: Sequence[WheelsetParameters],
    rail: Any,
    memory: RailMemory,
) -> None:
    """Do what comes before the controller decides: read the sensors, find the friction of the rail."""
    if p.fault_count > 0:
        update_faults(car, wheelsets, p, wheelset_parameters)
    read_sensors(car, wheelsets, p)
    if p.uses_pole_wheels > 0.0:
        read_pole_wheels(car, wheelsets, p)
    meet_rail(car, wheelsets, p, rail, memory)


def meet_rail(car: Car, wheelsets: Sequence[Wheelset], p: Parameters, rail: Any, memory: RailMemory) -> None:
    """Find the friction where the train has come to, then let faults falsify what the sensors have read."""
    if p.has_train_speed + p.has_accelerometer > 0.0:
        read_train_sensors(car, p)
    start_cycle(car, wheelsets, p, rail)
    if p.cleans_rail > 0.0:
        clean_rail(car, wheelsets, p, memory)
        if p.magnet_cleaning > 0.0:
            clean_by_magnets(car, wheelsets, p, memory)
    if p.has_sanders > 0.0:
        spread_sand(car, wheelsets, p, memory)
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
    if p.has_track_brake > 0.0:
        command_track_brake(car, p)
    if p.has_sanders > 0.0:
        command_sanders(car, wheelsets, p)
    if p.fault_count > 0:
        limit_valves(car, wheelsets, p)


def advance(car: Car, bogies: Sequence[Bogie], wheelsets: Sequence[Wheelset], p: Parameters) -> None:
    """Step a car, with what only some scenarios have."""
    if p.uses_module_air > 0.0:
        line = read_line_pressure(car, p)
        if p.calipers < 4:
            follow_tanks(wheelsets, line, p)
    if p.has_leaks > 0.0:
        let_air_leak(car, wheelsets, p)
    if p.has_dynamic_brake > 0.0:
        brake_dynamically(wheelsets, p)
    if p.has_track_brake > 0.0:
        drag_magnets(car, bogies, p)
    step(car, bogies, wheelsets, p)
    if p.has_track_brake > 0.0:
        account_for_magnets(car, bogies, p)


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
    observe_reports(car, wheelsets, measures, wheelset_measures, p)
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
