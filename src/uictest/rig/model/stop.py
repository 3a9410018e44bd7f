"""A controller cycle of one car, in the parts that lanes run too.

What takes :class:`~uictest.rig.model.records.CarRecords` branches or looks up tables: lanes run it one by
one. What takes :class:`~uictest.rig.model.records.Needs` has no other branch: lanes run it all at once.
"""

from collections.abc import Sequence
from typing import Any

from uictest.core.measures import StopMeasures, WheelsetMeasures, keep_tables
from uictest.rig.model.brake_command import follow_commands
from uictest.rig.model.cycle import start_cycle
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
from uictest.rig.model.rail import clean_rail, forget_rail
from uictest.rig.model.records import CarRecords, Needs
from uictest.rig.model.sand import command_sanders, forget_sand, spread_sand
from uictest.rig.model.start import start
from uictest.rig.model.state import Bogie, Car, Wheelset
from uictest.rig.model.step import step_vehicle
from uictest.rig.model.stop_measures import (
    begin_stop_measures,
    begin_tables,
    observe_cycle,
    observe_faults,
    observe_reports,
)
from uictest.rig.model.track_brake import (
    account_for_magnets,
    clean_by_magnets,
    command_track_brake,
    drag_magnets,
)
from uictest.rig.model.traction import hold_speed
from uictest.rig.model.train_sensors import read_train_sensors


def begin_stop(own: CarRecords) -> None:
    """Set zeroed records to the instant of the brake command."""
    start(own.car, own.bogies, own.wheelsets, own.parameters, own.wheelset_parameters)
    begin_stop_measures(own.car, own.measures, own.wheelset_measures, own.parameters)
    forget(own, own.measures, own.wheelset_measures)


def forget(own: CarRecords, measures: StopMeasures, wheelset_measures: Sequence[WheelsetMeasures]) -> None:
    """Empty the tables of the measures and what the rail remembers of a car."""
    p = own.parameters
    begin_tables(measures, wheelset_measures)
    if p.cleans_rail > 0.0:
        forget_rail(own.memory, p)
    if p.has_sanders > 0.0:
        forget_sand(own.memory)


def is_running(car: Car, p: Parameters) -> bool:
    """Whether the stop of a car goes on for another controller cycle."""
    return car.stopped == 0.0 and car.cycle < p.cycles and car.controller_failed == 0


def notice_faults(own: CarRecords) -> None:
    """Find which faults are active in a cycle, before the sensors are read."""
    if own.parameters.fault_count > 0:
        update_faults(own.car, own.wheelsets, own.parameters, own.wheelset_parameters)


def meet_rail(own: CarRecords, rail: Any) -> None:
    """Find the friction where a car has come to, then let faults falsify what its sensors have read."""
    car, wheelsets, p = own.car, own.wheelsets, own.parameters
    if p.has_train_speed + p.has_accelerometer > 0.0:
        read_train_sensors(car, p)
    start_cycle(car, wheelsets, p, rail)
    if p.cleans_rail > 0.0:
        clean_rail(car, wheelsets, p, own.memory)
        if p.magnet_cleaning > 0.0:
            clean_by_magnets(car, wheelsets, p, own.memory)
    if p.has_sanders > 0.0:
        spread_sand(car, wheelsets, p, own.memory)
    if p.fault_count > 0:
        falsify_readings(car, wheelsets, p)


def take_commands(own: CarRecords) -> None:
    """Let faults silence the controller that has decided, before its commands reach the valves."""
    if own.parameters.fault_count > 0:
        silence_controller(own.car, own.wheelsets, own.parameters)


def set_demands(own: CarRecords) -> None:
    """Set the demands of a cycle by what controller and driver ask for; limit faulty valves."""
    car, wheelsets, p = own.car, own.wheelsets, own.parameters
    if p.command_count > 1:
        follow_commands(car, own.measures, p)
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


def move_air(car: Car, wheelsets: Sequence[Wheelset], p: Parameters, needs: Needs) -> None:
    """Begin a step of the brake with what only some rigs have."""
    if needs.line_pressure:
        line = read_line_pressure(car, p)
        if needs.tanks:
            follow_tanks(wheelsets, line, p)
    if needs.leaks:
        let_air_leak(car, wheelsets, p)


def move_car(
    car: Car, bogies: Sequence[Bogie], wheelsets: Sequence[Wheelset], p: Parameters, needs: Needs
) -> None:
    """Make a step with the vehicle under its clamping forces."""
    if needs.dynamic_brake:
        brake_dynamically(wheelsets, p)
    if needs.track_brake:
        drag_magnets(car, bogies, p)
    step_vehicle(car, bogies, wheelsets, p)
    if needs.track_brake:
        account_for_magnets(car, bogies, p)


def end_cycle(
    car: Car,
    wheelsets: Sequence[Wheelset],
    measures: StopMeasures,
    wheelset_measures: Sequence[WheelsetMeasures],
    p: Parameters,
    needs: Needs,
) -> None:
    """Do what comes after the steps of a cycle: warm the discs, feed the measures."""
    if needs.disc_temperature:
        warm_discs(wheelsets, p)
    observe_cycle(car, wheelsets, measures, wheelset_measures, p)


def keep_measures(
    own: CarRecords, measures: StopMeasures, wheelset_measures: Sequence[WheelsetMeasures]
) -> None:
    """Feed the measures of faults and reports, and keep the tables in ``measures``, which may be the same."""
    car, wheelsets, p = own.car, own.wheelsets, own.parameters
    if p.fault_count > 0:
        observe_faults(car, wheelsets, own.measures, own.wheelset_measures, p)
    observe_reports(car, wheelsets, own.measures, own.wheelset_measures, p)
    keep_tables(measures, wheelset_measures, own.measures, own.wheelset_measures, p)
