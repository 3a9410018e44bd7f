"""Stops side by side: each lane runs one, and takes the next from a queue when it has ended.

Compiled only. What branches or looks up tables - friction laws, controllers, tables of measures - runs lane
by lane once per controller cycle; everything else runs in all lanes at once. A lane does what
:func:`uictest.rig.model.stop.run_stop` does, and its measures have the same bits.
"""

from typing import Any, NamedTuple

from uictest.core.lanes import align_stack, copy_from_lane, copy_to_lane, lane, vectors
from uictest.rig.model.brake_command import follow_commands
from uictest.rig.model.controller import decide
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
from uictest.rig.model.rail import clean_rail, forget_rail
from uictest.rig.model.sand import command_sanders, forget_sand, spread_sand
from uictest.rig.model.start import start
from uictest.rig.model.step import step
from uictest.rig.model.stop import is_running
from uictest.rig.model.stop_measures import (
    begin_stop_measures,
    begin_tables,
    close_stop_measures,
    keep_tables,
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

IDLE = -1
"""Number of a lane's case when it has none."""


class RigRecords(NamedTuple):
    """Records of one rig, or blocks of them in lanes: a car, two bogies, four wheelsets."""

    car: Any
    bogies: Any
    wheelsets: Any


class Needs(NamedTuple):
    """What the steps of a controller cycle have to do for any lane: how many there are, and what else."""

    steps: int
    reads_line: bool
    follows_air: bool
    warms_discs: bool
    leaks: bool
    brakes_dynamically: bool
    brakes_on_track: bool


class Lanes(NamedTuple):
    """Blocks of lanes (:func:`uictest.core.lanes.block`): a rig, its parameters, the measures of its stop."""

    rig: RigRecords
    settings: Any
    measures: Any
    wheelset_measures: Any


class Cases(NamedTuple):
    """Inputs of stops and the records that receive their measures, an entry for each case."""

    parameters: Any
    wheelset_parameters: Any
    rail: Any
    measures: Any
    wheelset_measures: Any


def run_queue(lanes: Lanes, blank: RigRecords, cases: Cases, queue: Any, running: Any, memories: Any) -> None:
    """Run the cases of ``queue`` in ``lanes`` and fill their measures.

    Args:
        lanes: blocks, all of as many lanes.
        blank: records of zeros, with which a lane begins.
        cases: parameters and measures of all cases.
        queue: numbers of the cases to be run, in the order in which they start; at least one, and all with
            the same number of steps in a controller cycle.
        running: for each lane, the number of its case; set here.
        memories: for each lane, what the rail of its case remembers; set here where a rail is cleaned.
    """
    align_stack()
    started = 0
    for k in range(running.size):
        # A lane for which no case is left steps this one: its numbers stay those of a stop.
        set_to_start(lanes, blank, cases, queue[0], k)
        started = _start_next_case(lanes, blank, cases, queue, running, memories, started, k)
    ended = 0
    while ended < queue.size:
        _run_cycle(lanes, cases, running, memories)
        for k in range(running.size):
            if running[k] != IDLE and finish_if_stopped(lanes, cases, running[k], k):
                ended += 1
                started = _start_next_case(lanes, blank, cases, queue, running, memories, started, k)


def _start_next_case(
    lanes: Lanes,
    blank: RigRecords,
    cases: Cases,
    queue: Any,
    running: Any,
    memories: Any,
    started: int,
    k: int,
) -> int:
    """Start the next case in lane ``k``, or leave it idle when none waits; return how many have started."""
    if started == queue.size:
        running[k] = IDLE
        return started
    running[k] = queue[started]
    begin_case(lanes, blank, cases, queue[started], memories, k)
    return started + 1


def begin_case(lanes: Lanes, blank: RigRecords, cases: Cases, case: int, memories: Any, k: int) -> None:
    """Begin the stop of a case in lane ``k``."""
    set_to_start(lanes, blank, cases, case, k)
    begin_tables(cases.measures[case], cases.wheelset_measures[case])
    if cases.parameters[case].cleans_rail > 0.0:
        forget_rail(memories[k], cases.parameters[case])
    if cases.parameters[case].has_sanders > 0.0:
        forget_sand(memories[k])


def set_to_start(lanes: Lanes, blank: RigRecords, cases: Cases, case: int, k: int) -> None:
    """Set lane ``k`` to the instant of the brake command of a case."""
    p, rig = cases.parameters[case], lanes.rig
    car, bogies, wheelsets = lane(rig.car, k), lane(rig.bogies, k), lane(rig.wheelsets, k)
    copy_to_lane(lane(lanes.settings, k), p)
    copy_to_lane(car, blank.car[0])
    for j in range(2):
        copy_to_lane(bogies[j], blank.bogies[j])
    for i in range(4):
        copy_to_lane(wheelsets[i], blank.wheelsets[i])
    start(car, bogies, wheelsets, p, cases.wheelset_parameters[case])
    begin_stop_measures(car, lane(lanes.measures, k), lane(lanes.wheelset_measures, k), p)


def _run_cycle(lanes: Lanes, cases: Cases, running: Any, memories: Any) -> None:
    """Step all lanes through a controller cycle."""
    needs = begin_cycle(lanes, cases, running, memories)
    for _ in range(needs.steps):
        advance(lanes, needs)
    end_cycle(lanes, needs)


def begin_cycle(lanes: Lanes, cases: Cases, running: Any, memories: Any) -> Needs:
    """Do what comes before the steps of a controller cycle; idle lanes skip their controller."""
    rig = lanes.rig
    car, wheelsets, settings = vectors(rig.car), vectors(rig.wheelsets), vectors(lanes.settings)
    steps = 0
    reads_line = False
    follows_air = False
    warms_discs = False
    leaks = False
    brakes_dynamically = False
    brakes_on_track = False
    _update_faults(lanes, cases, running)
    read_sensors(car, wheelsets, settings)
    if _any_pole_wheel(cases, running):
        read_pole_wheels(car, wheelsets, settings)
    for k in range(running.size):
        case = running[k]
        if case != IDLE:
            p = cases.parameters[case]
            if p.has_train_speed + p.has_accelerometer > 0.0:
                read_train_sensors(lane(rig.car, k), p)
            start_cycle(lane(rig.car, k), lane(rig.wheelsets, k), p, cases.rail[case])
            if p.cleans_rail > 0.0:
                clean_rail(lane(rig.car, k), lane(rig.wheelsets, k), p, memories[k])
                if p.magnet_cleaning > 0.0:
                    clean_by_magnets(lane(rig.car, k), lane(rig.wheelsets, k), p, memories[k])
            if p.has_sanders > 0.0:
                spread_sand(lane(rig.car, k), lane(rig.wheelsets, k), p, memories[k])
            if p.fault_count > 0:
                falsify_readings(lane(rig.car, k), lane(rig.wheelsets, k), p)
            decide(lane(rig.car, k), lane(rig.wheelsets, k), p)
            if p.fault_count > 0:
                silence_controller(lane(rig.car, k), lane(rig.wheelsets, k), p)
            if p.command_count > 1:
                follow_commands(lane(rig.car, k), lane(lanes.measures, k), p)
            if p.drag_duration > 0.0:
                hold_speed(lane(rig.car, k), p)
            if p.has_track_brake > 0.0:
                command_track_brake(lane(rig.car, k), p)
            steps = p.steps_per_cycle
            reads_line = reads_line or p.uses_module_air > 0.0
            follows_air = follows_air or (p.uses_module_air > 0.0 and p.calipers < 4)
            warms_discs = warms_discs or p.models_disc_temperature > 0.0
            leaks = leaks or p.has_leaks > 0.0
            brakes_dynamically = brakes_dynamically or p.has_dynamic_brake > 0.0
            brakes_on_track = brakes_on_track or p.has_track_brake > 0.0
    command_valves(car, wheelsets, settings)
    _follow_commands_of_valves(lanes, cases, running)
    return Needs(steps, reads_line, follows_air, warms_discs, leaks, brakes_dynamically, brakes_on_track)


def advance(lanes: Lanes, needs: Needs) -> None:
    """Make one step."""
    rig = lanes.rig
    car, bogies, wheelsets = vectors(rig.car), vectors(rig.bogies), vectors(rig.wheelsets)
    settings = vectors(lanes.settings)
    if needs.reads_line:
        line = read_line_pressure(car, settings)
        if needs.follows_air:
            follow_tanks(wheelsets, line, settings)
    if needs.leaks:
        let_air_leak(car, wheelsets, settings)
    if needs.brakes_dynamically:
        brake_dynamically(wheelsets, settings)
    if needs.brakes_on_track:
        drag_magnets(car, bogies, settings)
    step(car, bogies, wheelsets, settings)
    if needs.brakes_on_track:
        account_for_magnets(car, bogies, settings)


def end_cycle(lanes: Lanes, needs: Needs) -> None:
    """Do what comes after the steps of a controller cycle: warm the discs, feed the measures."""
    car, wheelsets, settings = vectors(lanes.rig.car), vectors(lanes.rig.wheelsets), vectors(lanes.settings)
    if needs.warms_discs:
        warm_discs(wheelsets, settings)
    observe_cycle(car, wheelsets, vectors(lanes.measures), vectors(lanes.wheelset_measures), settings)


def _update_faults(lanes: Lanes, cases: Cases, running: Any) -> None:
    """Decide lane by lane which faults are active."""
    for k in range(running.size):
        case = running[k]
        if case != IDLE and cases.parameters[case].fault_count > 0:
            car, wheelsets = lane(lanes.rig.car, k), lane(lanes.rig.wheelsets, k)
            update_faults(car, wheelsets, cases.parameters[case], cases.wheelset_parameters[case])


def _follow_commands_of_valves(lanes: Lanes, cases: Cases, running: Any) -> None:
    """Divide lane by lane the force between the brakes, command the sanders, limit faulty valves."""
    for k in range(running.size):
        case = running[k]
        if case != IDLE:
            p, car, wheelsets = cases.parameters[case], lane(lanes.rig.car, k), lane(lanes.rig.wheelsets, k)
            if p.has_dynamic_brake > 0.0:
                demand_dynamic_brake(car, wheelsets, p)
            if p.has_sanders > 0.0:
                command_sanders(car, wheelsets, p)
            if p.fault_count > 0:
                limit_valves(car, wheelsets, p)


def _any_pole_wheel(cases: Cases, running: Any) -> bool:
    """Whether the case of any lane has a sensor that the pole wheels are read for."""
    found = False
    for k in range(running.size):
        if running[k] != IDLE:
            found = found or cases.parameters[running[k]].uses_pole_wheels > 0.0
    return found


def finish_if_stopped(lanes: Lanes, cases: Cases, case: int, k: int) -> bool:
    """Keep the tables after a cycle of lane ``k``; complete the measures and return True after the last."""
    p, rig = cases.parameters[case], lanes.rig
    measures, wheelset_measures = cases.measures[case], cases.wheelset_measures[case]
    car, bogies, wheelsets = lane(rig.car, k), lane(rig.bogies, k), lane(rig.wheelsets, k)
    samples, wheelset_samples = lane(lanes.measures, k), lane(lanes.wheelset_measures, k)
    if p.fault_count > 0:
        observe_faults(car, wheelsets, samples, wheelset_samples, p)
    observe_reports(car, wheelsets, samples, wheelset_samples, p)
    keep_tables(measures, wheelset_measures, samples, wheelset_samples, p)
    if is_running(car, p):
        return False
    copy_from_lane(measures, samples)
    for i in range(4):
        copy_from_lane(wheelset_measures[i], wheelset_samples[i])
    close_stop_measures(car, bogies, wheelsets, measures, wheelset_measures, p)
    return True
