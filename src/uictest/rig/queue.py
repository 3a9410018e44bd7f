"""Trains side by side: each lane runs one, and takes the next from a queue when all of its cars stand.

Compiled only. A lane does what :func:`uictest.rig.model.train.run_train` does, and its measures have the same
bits. What branches or looks up tables runs lane by lane, once per controller cycle; everything else runs in
all lanes at once. The brake makes its steps of a cycle before the vehicle.
"""

from typing import Any, NamedTuple

from uictest.rig.kernel.arguments import copy_from_lane, copy_to_lane, lane, vectors
from uictest.rig.model.controller import decide
from uictest.rig.model.cycle import command_valves, read_sensors
from uictest.rig.model.records import CarRecords, Needs, needs_of, needs_of_both
from uictest.rig.model.step import compensate_kept, step_modules, step_other_calipers, take_clamping_forces
from uictest.rig.model.stop import (
    end_cycle,
    forget,
    is_running,
    keep_measures,
    meet_rail,
    move_air,
    move_car,
    notice_faults,
    set_demands,
    start,
    take_commands,
)
from uictest.rig.model.stop_measures import begin_stop_measures, close_stop_measures
from uictest.rig.model.train import account_for_coupler, hand_on, pull_cars, release_couplers

IDLE = -1
"""Number of a lane's train when it has none."""


class Lanes(NamedTuple):
    """Blocks of lanes (:func:`uictest.rig.kernel.arguments.block`) of a train of n cars, car by car.

    `settings` are the parameters, `module_steps` the four modules of every step of a cycle.
    """

    cars: Any
    bogies: Any
    wheelsets: Any
    settings: Any
    measures: Any
    wheelset_measures: Any
    module_steps: Any
    couplers: Any


class Blank(NamedTuple):
    """Records of one car, all zero."""

    car: Any
    bogies: Any
    wheelsets: Any


class Trains(NamedTuple):
    """Inputs of trains of n cars and the records that receive their measures, an entry for each train.

    Parameters and measures have shape (n, trains), those of wheelsets (n, trains, 4), distances (n, trains).
    The rail is one for all cars, shape (trains, 4, points), couplers have shape (trains, n - 1).
    """

    parameters: Any
    wheelset_parameters: Any
    rail: Any
    distances: Any
    couplers: Any
    measures: Any
    wheelset_measures: Any


class Queue(NamedTuple):
    """What lanes run.

    Attributes:
        lanes: blocks, all of as many lanes.
        blank: with which a lane begins.
        trains: parameters and measures of all trains, with as many cars and steps in a controller cycle.
        order: numbers of the trains to be run, in the order in which they start; at least one.
        running: for each lane, the number of its train; set here.
        memories: for each car and lane, what the rail remembers, shape (n, lanes); set here.
    """

    lanes: Lanes
    blank: Blank
    trains: Trains
    order: Any
    running: Any
    memories: Any


def run_queue(queue: Queue) -> None:
    """Run the trains of a queue; fill their measures and the ledgers of their couplers."""
    started = 0
    for k in range(len(queue.running)):
        # A lane for which no train is left steps this one: its numbers stay those of a stop.
        for j in range(len(queue.memories)):
            _set_to_start(queue, queue.order[0], j, k)
        started = _start_next(queue, started, k)
    ended = 0
    while ended < len(queue.order):
        _run_cycle(queue)
        for k in range(len(queue.running)):
            if queue.running[k] != IDLE and _finish_if_all_stand(queue, k):
                ended += 1
                started = _start_next(queue, started, k)


def _start_next(queue: Queue, started: int, k: int) -> int:
    if started == len(queue.order):
        queue.running[k] = IDLE
        return started
    number, trains = queue.order[started], queue.trains
    queue.running[k] = number
    for j in range(len(queue.memories)):
        _set_to_start(queue, number, j, k)
        records = _car(queue, j, k)
        forget(records, trains.measures[j, number], trains.wheelset_measures[j, number])
        for i in range(4):
            records.wheelsets[i].behind += trains.distances[j, number]
    for j in range(len(queue.lanes.couplers)):
        copy_to_lane(lane(queue.lanes.couplers, k)[j], trains.couplers[number, j])
    return started + 1


def _set_to_start(queue: Queue, number: int, j: int, k: int) -> None:
    p, lanes, blank = queue.trains.parameters[j, number], queue.lanes, queue.blank
    car, bogies, wheelsets = (
        lane(lanes.cars, k)[j],
        lane(lanes.bogies, k)[2 * j],
        lane(lanes.wheelsets, k)[4 * j],
    )
    copy_to_lane(lane(lanes.settings, k)[j], p)
    copy_to_lane(car, blank.car[0])
    for i in range(2):
        copy_to_lane(bogies[i], blank.bogies[i])
    for i in range(4):
        copy_to_lane(wheelsets[i], blank.wheelsets[i])
    start(car, bogies, wheelsets, p, queue.trains.wheelset_parameters[j, number])
    begin_stop_measures(car, lane(lanes.measures, k)[j], lane(lanes.wheelset_measures, k)[4 * j], p)


def _car(queue: Queue, j: int, k: int) -> CarRecords:
    """Return car ``j`` as lane ``k`` has it, with the tables of its train's parameters."""
    lanes, number = queue.lanes, queue.running[k]
    return CarRecords(
        lane(lanes.cars, k)[j],
        lane(lanes.bogies, k)[2 * j],
        lane(lanes.wheelsets, k)[4 * j],
        queue.trains.parameters[j, number],
        queue.trains.wheelset_parameters[j, number],
        queue.memories[j, k],
        lane(lanes.measures, k)[j],
        lane(lanes.wheelset_measures, k)[4 * j],
    )


def _run_cycle(queue: Queue) -> None:
    needs = _needs(queue)
    for j in range(len(queue.memories)):
        _begin_cycle(queue, needs, j)
    for j in range(len(queue.memories)):
        _step_brakes(queue.lanes, needs, j)
    for n in range(needs.steps):
        _step_vehicles(queue.lanes, needs, n)
    lanes = queue.lanes
    for j in range(len(queue.memories)):
        car, wheelsets = vectors(lanes.cars)[j], vectors(lanes.wheelsets)[4 * j]
        measures, of_wheelsets = vectors(lanes.measures)[j], vectors(lanes.wheelset_measures)[4 * j]
        end_cycle(car, wheelsets, measures, of_wheelsets, vectors(lanes.settings)[j], needs)


def _needs(queue: Queue) -> Needs:
    needs = Needs(0, False, False, False, False, False, False, False, False)
    for k in range(len(queue.running)):
        if queue.running[k] != IDLE:
            for j in range(len(queue.memories)):
                needs = needs_of_both(needs, needs_of(queue.trains.parameters[j, queue.running[k]]))
    return needs


def _begin_cycle(queue: Queue, needs: Needs, j: int) -> None:
    """Do what comes before the steps of a controller cycle of car ``j``; idle lanes skip their controller."""
    lanes = queue.lanes
    car, wheelsets, settings = (
        vectors(lanes.cars)[j],
        vectors(lanes.wheelsets)[4 * j],
        vectors(lanes.settings)[j],
    )
    for k in range(len(queue.running)):
        if queue.running[k] != IDLE:
            notice_faults(_car(queue, j, k))
    read_sensors(car, wheelsets, settings, needs)
    for k in range(len(queue.running)):
        if queue.running[k] != IDLE:
            records = _car(queue, j, k)
            meet_rail(records, queue.trains.rail[queue.running[k]])
            if j + 1 < len(queue.memories):
                hand_on(records, queue.memories[j + 1, k])
            decide(records.car, records.wheelsets, records.parameters)
            take_commands(records)
    command_valves(car, wheelsets, settings)
    for k in range(len(queue.running)):
        if queue.running[k] != IDLE:
            set_demands(_car(queue, j, k))


def _step_brakes(lanes: Lanes, needs: Needs, j: int) -> None:
    """Make the steps of a controller cycle with the brake of car ``j``, and keep the clamping forces.

    What a module without a caliper gives follows from the readings of its pressure alone. So it is computed
    module by module: its few numbers stay in registers.
    """
    car, wheelsets, settings = (
        vectors(lanes.cars)[j],
        vectors(lanes.wheelsets)[4 * j],
        vectors(lanes.settings)[j],
    )
    modules = vectors(lanes.module_steps)[4 * needs.steps * j]
    for n in range(needs.steps):
        move_air(car, wheelsets, settings, needs)
        step_modules(car, wheelsets, modules[4 * n], settings)
        if needs.calipers:
            step_other_calipers(wheelsets, modules[4 * n], settings)
    for i in range(1, 4):
        for n in range(needs.steps):
            compensate_kept(wheelsets[i], modules[4 * n + i], settings)


def _step_vehicles(lanes: Lanes, needs: Needs, n: int) -> None:
    """Make step ``n`` of a cycle; all coupler forces come from the state before any car moves."""
    cars, settings, couplers = vectors(lanes.cars), vectors(lanes.settings), vectors(lanes.couplers)
    for j in range(len(lanes.cars)):
        release_couplers(cars[j])
    for j in range(len(lanes.couplers)):
        pull_cars(couplers[j], cars[j], settings[j], cars[j + 1], settings[j + 1])
    for j in range(len(lanes.cars)):
        wheelsets = vectors(lanes.wheelsets)[4 * j]
        take_clamping_forces(wheelsets, vectors(lanes.module_steps)[4 * (needs.steps * j + n)])
        move_car(cars[j], vectors(lanes.bogies)[2 * j], wheelsets, settings[j], needs)
    for j in range(len(lanes.couplers)):
        account_for_coupler(couplers[j], cars[j], settings[j], cars[j + 1], settings[j + 1])


def _finish_if_all_stand(queue: Queue, k: int) -> bool:
    """Complete the measures of the cars of lane ``k`` that have come to stand; return whether all have."""
    all_stand = True
    for j in range(len(queue.memories)):
        records = _car(queue, j, k)
        if records.car.closed == 0.0:
            if _finish_if_stopped(queue, records, j, queue.running[k]):
                records.car.closed = 1.0
            else:
                all_stand = False
    if all_stand:
        for j in range(len(queue.lanes.couplers)):
            copy_from_lane(queue.trains.couplers[queue.running[k], j], lane(queue.lanes.couplers, k)[j])
    return all_stand


def _finish_if_stopped(queue: Queue, records: CarRecords, j: int, number: int) -> bool:
    """Keep the tables after a cycle of a car; complete the measures and return True after its last."""
    measures, wheelset_measures = queue.trains.measures[j, number], queue.trains.wheelset_measures[j, number]
    keep_measures(records, measures, wheelset_measures)
    if is_running(records.car, records.parameters):
        return False
    copy_from_lane(measures, records.measures)
    for i in range(4):
        copy_from_lane(wheelset_measures[i], records.wheelset_measures[i])
    close_stop_measures(
        CarRecords(
            *(
                records.car,
                records.bogies,
                records.wheelsets,
                records.parameters,
                records.wheelset_parameters,
                records.memory,
            ),
            *(measures, wheelset_measures),
        )
    )
    return True
