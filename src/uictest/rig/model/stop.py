"""The stop of one car: its state at the brake command, and a controller cycle in the parts that lanes run.

At the brake command the train rolls with its brakes released.

What takes :class:`~uictest.rig.model.records.CarRecords` branches or looks up tables: lanes run it one by
one. What takes :class:`~uictest.rig.model.records.Needs` has no other branch: lanes run it all at once.
"""

from collections.abc import Sequence
from typing import Any

from uictest.core.measures import StopMeasures, WheelsetMeasures, keep_tables
from uictest.core.physics import select
from uictest.rig.model.balance import stored_air, stored_air_energy, stored_energy
from uictest.rig.model.controller import begin
from uictest.rig.model.cycle import read_train_sensors, start_cycle
from uictest.rig.model.dynamic_brake import brake_dynamically, demand_dynamic_brake, start_dynamic_brake
from uictest.rig.model.faults import (
    falsify_readings,
    let_air_leak,
    limit_valves,
    silence_controller,
    update_faults,
)
from uictest.rig.model.friction_brake import follow_tanks, read_line_pressure, start_disc, warm_discs
from uictest.rig.model.parameters import Parameters, WheelsetParameters, copy_wheelset_parameters
from uictest.rig.model.pneumatics import follow_commands, start_command
from uictest.rig.model.rail import clean_rail, forget_rail, set_creep_curve
from uictest.rig.model.records import CarRecords, Needs
from uictest.rig.model.running_gear import hold_speed
from uictest.rig.model.sand import command_sanders, forget_sand, spread_sand
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


def begin_stop(records: CarRecords) -> None:
    """Set zeroed records to the instant of the brake command."""
    start(records.car, records.bogies, records.wheelsets, records.parameters, records.wheelset_parameters)
    begin_stop_measures(records.car, records.measures, records.wheelset_measures, records.parameters)
    forget(records, records.measures, records.wheelset_measures)


def forget(
    records: CarRecords, measures: StopMeasures, wheelset_measures: Sequence[WheelsetMeasures]
) -> None:
    """Empty the tables of the measures and what the rail remembers of a car."""
    p = records.parameters
    begin_tables(measures, wheelset_measures)
    if p.cleans_rail > 0.0:
        forget_rail(records.memory, p)
    if p.has_sanders > 0.0:
        forget_sand(records.memory)


def is_running(car: Car, p: Parameters) -> bool:
    """Whether the stop of a car goes on for another controller cycle."""
    return car.stopped == 0.0 and car.cycle < p.cycles and car.controller_failed == 0


def notice_faults(records: CarRecords) -> None:
    """Find which faults are active in a cycle, before the sensors are read."""
    if records.parameters.fault_count > 0:
        update_faults(records.car, records.wheelsets, records.parameters, records.wheelset_parameters)


def meet_rail(records: CarRecords, rail: Any) -> None:
    """Find the friction where a car has come to, then let faults falsify what its sensors have read."""
    car, wheelsets, p = records.car, records.wheelsets, records.parameters
    if p.has_train_speed + p.has_accelerometer > 0.0:
        read_train_sensors(car, p)
    start_cycle(car, wheelsets, p, rail)
    if p.cleans_rail > 0.0:
        clean_rail(car, wheelsets, p, records.memory)
        if p.magnet_cleaning > 0.0:
            clean_by_magnets(car, wheelsets, p, records.memory)
    if p.has_sanders > 0.0:
        spread_sand(car, wheelsets, p, records.memory)
    if p.fault_count > 0:
        falsify_readings(car, wheelsets, p)


def take_commands(records: CarRecords) -> None:
    """Let faults silence the controller that has decided, before its commands reach the valves."""
    if records.parameters.fault_count > 0:
        silence_controller(records.car, records.wheelsets, records.parameters)


def set_demands(records: CarRecords) -> None:
    """Set the demands of a cycle by what controller and driver ask for; limit faulty valves."""
    car, wheelsets, p = records.car, records.wheelsets, records.parameters
    if p.command_count > 1:
        follow_commands(car, records.measures, p)
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
    records: CarRecords, measures: StopMeasures, wheelset_measures: Sequence[WheelsetMeasures]
) -> None:
    """Feed the measures of faults and reports, and keep the tables in ``measures``, which may be the same."""
    car, wheelsets, p = records.car, records.wheelsets, records.parameters
    if p.fault_count > 0:
        observe_faults(car, wheelsets, records.measures, records.wheelset_measures, p)
    observe_reports(car, wheelsets, records.measures, records.wheelset_measures, p)
    keep_tables(measures, wheelset_measures, records.measures, records.wheelset_measures, p)


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
