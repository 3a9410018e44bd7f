"""One stop of a train: several cars, each with its own rig, coupled, on one rail.

A car is what it is alone: its functions get the parts of the train's records that are its own. Between them
are the couplers and the rail, which keeps what the wheelsets of all cars before have cleaned.
"""

from collections.abc import Sequence
from typing import Any

from uictest.controllers import NO_FAILURE
from uictest.core.measures import StopMeasures, WheelsetMeasures
from uictest.rig.model.controller import FROM_OUTSIDE, decide_watched, read_outputs, write_inputs
from uictest.rig.model.couplers import Coupler, account_for_coupler, pull_cars, release_couplers
from uictest.rig.model.disc_brake import warm_discs
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.rail import RailMemory, hand_rail_on
from uictest.rig.model.sand import hand_sand_on
from uictest.rig.model.state import Bogie, Car, Wheelset
from uictest.rig.model.stop import act, advance, begin_cycle, begin_stop, end_cycle, is_running
from uictest.rig.model.stop_measures import close_stop_measures
from uictest.rig.model.trace import Trace, sample
from uictest.rig.model.wheelset_parameters import WheelsetParameters


def run_train(
    cars: Sequence[Car],
    bogies: Sequence[Bogie],
    wheelsets: Sequence[Wheelset],
    parameters: Sequence[Parameters],
    wheelset_parameters: Sequence[WheelsetParameters],
    distances: Sequence[float],
    couplers: Sequence[Coupler],
    rail: Any,
    memories: Sequence[RailMemory],
    measures: Sequence[StopMeasures],
    wheelset_measures: Sequence[WheelsetMeasures],
    train_samples: Any,
    wheelset_samples: Any,
    steps_per_sample: int,
) -> int:
    """Run one stop of n cars on zeroed records; fill the measures and return the rows written to the traces.

    The measures of a car are those up to its own standstill. It stays coupled until all cars stand. A train
    of one car gives the bits of :func:`uictest.rig.model.stop.run_stop`.

    Args:
        cars: n records.
        bogies: 2 n records.
        wheelsets: 4 n records, in the order of the train.
        parameters: n records with one step and one length of the controller cycle.
        wheelset_parameters: 4 n records.
        distances: of each car's first wheelset behind that of the train, m.
        couplers: n - 1 records, with their numbers set.
        rail: friction laws, places counted from the first wheelset of the train.
        memories: n records.
        measures: n records.
        wheelset_measures: 4 n records.
        train_samples: of every car, shape (n, rows).
        wheelset_samples: likewise, shape (n, rows, 4).
        steps_per_sample: base steps from one sample to the next; 0: none.
    """
    begin_train(
        *(cars, bogies, wheelsets, parameters, wheelset_parameters, distances),
        *(memories, measures, wheelset_measures),
    )
    rows = 0
    running = len(cars)
    while running > 0:
        for j in range(len(cars)):
            _begin_cycle(j, cars, wheelsets, parameters, wheelset_parameters, rail, memories)
            own = wheelsets[4 * j : 4 * j + 4]
            decide_watched(j, cars, own, parameters)
            act(cars[j], own, parameters[j], measures[j])
        rows = _step_cycle(
            *(cars, bogies, wheelsets, parameters, couplers),
            *(train_samples, wheelset_samples, steps_per_sample, rows),
        )
        running = _observe(cars, bogies, wheelsets, parameters, measures, wheelset_measures)
    return rows


def step_train(
    cars: Sequence[Car],
    bogies: Sequence[Bogie],
    wheelsets: Sequence[Wheelset],
    parameters: Sequence[Parameters],
    wheelset_parameters: Sequence[WheelsetParameters],
    distances: Sequence[float],
    couplers: Sequence[Coupler],
    rail: Any,
    memories: Sequence[RailMemory],
    measures: Sequence[StopMeasures],
    wheelset_measures: Sequence[WheelsetMeasures],
    exchanges: Any,
    present: Trace,
    train_samples: Any,
    wheelset_samples: Any,
    steps_per_sample: int,
    rows: int,
) -> int:
    """Carry out the commands in the exchanges for one cycle; on zeroed records, begin the stop instead.

    The arguments of :func:`run_train`, with an exchange for each car and, as traces of one row, the true
    state. What :func:`uictest.rig.model.stop.step_stop` says holds for all cars: while a command of one is
    refused, none moves. A car is asked for commands until all cars have ended.
    """
    if exchanges[0].cycles == 0:
        for j in range(len(cars)):
            parameters[j].controller = FROM_OUTSIDE
        begin_train(
            *(cars, bogies, wheelsets, parameters, wheelset_parameters, distances),
            *(memories, measures, wheelset_measures),
        )
    else:
        if not _read_commands(cars, wheelsets, parameters, exchanges):
            return rows
        for j in range(len(cars)):
            act(cars[j], wheelsets[4 * j : 4 * j + 4], parameters[j], measures[j])
        rows = _step_cycle(
            *(cars, bogies, wheelsets, parameters, couplers),
            *(train_samples, wheelset_samples, steps_per_sample, rows),
        )
        _observe(cars, bogies, wheelsets, parameters, measures, wheelset_measures)
    for j in range(len(cars)):
        _begin_cycle(j, cars, wheelsets, parameters, wheelset_parameters, rail, memories)
        write_inputs(exchanges[j], cars[j], wheelsets[4 * j : 4 * j + 4], parameters[j])
        exchanges[j].cycles += 1
    _sample(cars, wheelsets, parameters, present.train, present.wheelsets, 0)
    return rows


def _read_commands(
    cars: Sequence[Car], wheelsets: Sequence[Wheelset], parameters: Sequence[Parameters], exchanges: Any
) -> bool:
    """Set what is commanded of every car; return whether all of it can be carried out."""
    sound = True
    for j in range(len(cars)):
        exchanges[j].failure = NO_FAILURE
        read_outputs(exchanges[j], cars[j], wheelsets[4 * j : 4 * j + 4], parameters[j])
        sound = sound and exchanges[j].failure == NO_FAILURE
    return sound


def begin_train(
    cars: Sequence[Car],
    bogies: Sequence[Bogie],
    wheelsets: Sequence[Wheelset],
    parameters: Sequence[Parameters],
    wheelset_parameters: Sequence[WheelsetParameters],
    distances: Sequence[float],
    memories: Sequence[RailMemory],
    measures: Sequence[StopMeasures],
    wheelset_measures: Sequence[WheelsetMeasures],
) -> None:
    """Set zeroed records to the instant of the brake command."""
    for j in range(len(cars)):
        begin_stop(
            cars[j],
            bogies[2 * j : 2 * j + 2],
            wheelsets[4 * j : 4 * j + 4],
            parameters[j],
            wheelset_parameters[4 * j : 4 * j + 4],
            memories[j],
            measures[j],
            wheelset_measures[4 * j : 4 * j + 4],
        )
        for i in range(4):
            wheelsets[4 * j + i].behind += distances[j]


def _begin_cycle(
    j: int,
    cars: Sequence[Car],
    wheelsets: Sequence[Wheelset],
    parameters: Sequence[Parameters],
    wheelset_parameters: Sequence[WheelsetParameters],
    rail: Any,
    memories: Sequence[RailMemory],
) -> None:
    """Begin a cycle of car ``j`` and leave to the next car the rail that its last wheelset has passed."""
    own = wheelsets[4 * j : 4 * j + 4]
    begin_cycle(cars[j], own, parameters[j], wheelset_parameters[4 * j : 4 * j + 4], rail, memories[j])
    if parameters[j].cleans_rail > 0.0 and j + 1 < len(cars):
        hand_rail_on(own[3], parameters[j], memories[j], memories[j + 1])
    if parameters[j].has_sanders > 0.0 and j + 1 < len(cars):
        hand_sand_on(own[3], parameters[j], memories[j], memories[j + 1])


def _step_cycle(
    cars: Sequence[Car],
    bogies: Sequence[Bogie],
    wheelsets: Sequence[Wheelset],
    parameters: Sequence[Parameters],
    couplers: Sequence[Coupler],
    train_samples: Any,
    wheelset_samples: Any,
    steps_per_sample: int,
    rows: int,
) -> int:
    """Step all cars through a controller cycle; return the rows that the traces have then."""
    p = parameters[0]
    steps = (cars[0].cycle - 1) * p.steps_per_cycle
    if steps_per_sample > 0 and rows == 0:
        rows = _sample(cars, wheelsets, parameters, train_samples, wheelset_samples, rows)
    for _ in range(p.steps_per_cycle):
        for j in range(len(cars)):
            release_couplers(cars[j])
        for j in range(len(couplers)):
            pull_cars(couplers[j], cars[j], parameters[j], cars[j + 1], parameters[j + 1])
        for j in range(len(cars)):
            advance(cars[j], bogies[2 * j : 2 * j + 2], wheelsets[4 * j : 4 * j + 4], parameters[j])
        for j in range(len(couplers)):
            account_for_coupler(couplers[j], cars[j], parameters[j], cars[j + 1], parameters[j + 1])
        steps += 1
        if steps_per_sample > 0 and steps % steps_per_sample == 0:
            rows = _sample(cars, wheelsets, parameters, train_samples, wheelset_samples, rows)
    return rows


def _sample(
    cars: Sequence[Car],
    wheelsets: Sequence[Wheelset],
    parameters: Sequence[Parameters],
    train_samples: Any,
    wheelset_samples: Any,
    row: int,
) -> int:
    for j in range(len(cars)):
        trace = Trace(train_samples[j], wheelset_samples[j])
        sample(trace, row, cars[j], wheelsets[4 * j : 4 * j + 4], parameters[j])
    return row + 1


def _observe(
    cars: Sequence[Car],
    bogies: Sequence[Bogie],
    wheelsets: Sequence[Wheelset],
    parameters: Sequence[Parameters],
    measures: Sequence[StopMeasures],
    wheelset_measures: Sequence[WheelsetMeasures],
) -> int:
    """End a cycle: feed the measures of the cars that ran in it; return how many run on.

    None does where a controller from outside has failed. All begin their cycles together, so that a car
    whose measures are closed is one that had stopped before.
    """
    running = 0
    failed = 0
    for j in range(len(cars)):
        failed += cars[j].controller_failed
        car, p, of_stop = cars[j], parameters[j], measures[j]
        own, of_wheelsets = wheelsets[4 * j : 4 * j + 4], wheelset_measures[4 * j : 4 * j + 4]
        if car.closed > 0.0:
            if p.models_disc_temperature > 0.0:
                warm_discs(own, p)  # others may still push the car along
            continue
        end_cycle(car, own, p, of_stop, of_wheelsets)
        if is_running(car, p):
            running += 1
        else:
            close_stop_measures(car, bogies[2 * j : 2 * j + 2], own, of_stop, of_wheelsets, p)
            car.closed = 1.0
    return 0 if failed > 0 else running
