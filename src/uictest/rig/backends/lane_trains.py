"""Trains side by side: each lane runs one, and takes the next from a queue when all of its cars stand.

A car of all lanes is what a rig is for single stops, :mod:`uictest.rig.backends.lane_stops`; between the cars
are couplers and the rail. A lane does what :func:`uictest.rig.model.train.run_train` does, with the same
bits. All trains of a queue have as many cars and as many steps in a controller cycle.
"""

from typing import Any

from uictest.core.lanes import align_stack, copy_from_lane, copy_to_lane, lane, vectors
from uictest.rig.backends.lane_cycle import (
    IDLE,
    Needs,
    advance_brake,
    advance_vehicle,
    begin_cycle,
    end_cycle,
)
from uictest.rig.backends.lane_records import Cases, Lanes, RigRecords, Trains
from uictest.rig.backends.lane_stops import begin_case, finish_if_stopped, set_to_start
from uictest.rig.model.couplers import account_for_coupler, pull_cars, release_couplers
from uictest.rig.model.rail import hand_rail_on
from uictest.rig.model.sand import hand_sand_on


def run_train_queue(
    lanes: Lanes, couplers: Any, blank: RigRecords, trains: Trains, queue: Any, running: Any, memories: Any
) -> None:
    """Run the trains of ``queue`` in ``lanes``; fill their measures and the ledgers of their couplers.

    Args:
        lanes: blocks of n cars, all of as many lanes.
        couplers: block of n - 1 couplers.
        blank: records of zeros of one car, with which a lane begins.
        trains: parameters and measures of all trains.
        queue: numbers of the trains to be run, in the order in which they start; at least one.
        running: for each lane, the number of its train; set here.
        memories: for each car and lane, what the rail remembers, shape (n, lanes); set here.
    """
    align_stack()
    started = 0
    for k in range(running.size):
        # As with single stops: a lane for which no train is left steps this one.
        for j in range(len(trains.parameters)):
            set_to_start(_lanes_of(lanes, j), blank, _cases_of(trains, j), queue[0], k)
        started = _start_next(lanes, couplers, blank, trains, queue, running, memories, started, k)
    ended = 0
    while ended < queue.size:
        _run_cycle(lanes, couplers, trains, running, memories)
        for k in range(running.size):
            if running[k] != IDLE and _finish_if_all_stand(lanes, couplers, trains, running[k], k):
                ended += 1
                started = _start_next(lanes, couplers, blank, trains, queue, running, memories, started, k)


def _lanes_of(lanes: Lanes, j: int) -> Lanes:
    """Return the part of the blocks that is car ``j``."""
    rig = lanes.rig
    kept = len(lanes.module_steps) // len(rig.car)
    return Lanes(
        RigRecords(rig.car[j : j + 1], rig.bogies[2 * j : 2 * j + 2], rig.wheelsets[4 * j : 4 * j + 4]),
        lanes.settings[j : j + 1],
        lanes.measures[j : j + 1],
        lanes.wheelset_measures[4 * j : 4 * j + 4],
        lanes.module_steps[j * kept : (j + 1) * kept],
    )


def _cases_of(trains: Trains, j: int) -> Cases:
    """Return car ``j`` of all trains as cases."""
    return Cases(
        trains.parameters[j],
        trains.wheelset_parameters[j],
        trains.rail,
        trains.measures[j],
        trains.wheelset_measures[j],
    )


def _start_next(
    lanes: Lanes,
    couplers: Any,
    blank: RigRecords,
    trains: Trains,
    queue: Any,
    running: Any,
    memories: Any,
    started: int,
    k: int,
) -> int:
    """Start the next train in lane ``k``, or leave it idle when none waits; return how many have started."""
    if started == queue.size:
        running[k] = IDLE
        return started
    train = queue[started]
    running[k] = train
    for j in range(len(trains.parameters)):
        own = _lanes_of(lanes, j)
        begin_case(own, blank, _cases_of(trains, j), train, memories[j], k)
        for i in range(4):
            lane(own.rig.wheelsets, k)[i].behind += trains.distances[j, train]
    for j in range(len(couplers)):
        copy_to_lane(lane(couplers, k)[j], trains.couplers[train, j])
    return started + 1


def _run_cycle(lanes: Lanes, couplers: Any, trains: Trains, running: Any, memories: Any) -> None:
    """Step all lanes through a controller cycle."""
    needs = Needs(0, False, False, False, False, False, False, False, False)
    for j in range(len(trains.parameters)):
        needs = _of_both(needs, begin_cycle(_lanes_of(lanes, j), _cases_of(trains, j), running, memories[j]))
        if j + 1 < len(trains.parameters):
            _hand_rail_on(_lanes_of(lanes, j), trains.parameters[j], running, memories[j], memories[j + 1])
    for j in range(len(trains.parameters)):
        advance_brake(_lanes_of(lanes, j), needs)
    for n in range(needs.steps):
        _advance_vehicles(lanes, couplers, needs, n)
    for j in range(len(trains.parameters)):
        end_cycle(_lanes_of(lanes, j), needs)


def _of_both(one: Needs, other: Needs) -> Needs:
    return Needs(
        other.steps,
        one.reads_pole_wheels or other.reads_pole_wheels,
        one.reads_line or other.reads_line,
        one.follows_air or other.follows_air,
        one.warms_discs or other.warms_discs,
        one.leaks or other.leaks,
        one.brakes_dynamically or other.brakes_dynamically,
        one.brakes_on_track or other.brakes_on_track,
        one.has_four_calipers or other.has_four_calipers,
    )


def _hand_rail_on(lanes: Lanes, parameters: Any, running: Any, memories: Any, behind: Any) -> None:
    """Leave to the next car, lane by lane, the rail that the last wheelset of this one has passed."""
    for k in range(running.size):
        if running[k] != IDLE:
            last, p = lane(lanes.rig.wheelsets, k)[3], parameters[running[k]]
            if p.cleans_rail > 0.0:
                hand_rail_on(last, p, memories[k], behind[k])
            if p.has_sanders > 0.0:
                hand_sand_on(last, p, memories[k], behind[k])


def _advance_vehicles(lanes: Lanes, couplers: Any, needs: Needs, n: int) -> None:
    """Make step ``n`` of a cycle; all coupler forces come from the state before any car is advanced."""
    cars, settings, between = vectors(lanes.rig.car), vectors(lanes.settings), vectors(couplers)
    for j in range(len(lanes.rig.car)):
        release_couplers(cars[j])
    for j in range(len(couplers)):
        pull_cars(between[j], cars[j], settings[j], cars[j + 1], settings[j + 1])
    for j in range(len(lanes.rig.car)):
        advance_vehicle(_lanes_of(lanes, j), needs, n)
    for j in range(len(couplers)):
        account_for_coupler(between[j], cars[j], settings[j], cars[j + 1], settings[j + 1])


def _finish_if_all_stand(lanes: Lanes, couplers: Any, trains: Trains, train: int, k: int) -> bool:
    """Complete the measures of the cars of lane ``k`` that have come to stand; return whether all have."""
    all_stand = True
    for j in range(len(trains.parameters)):
        own = _lanes_of(lanes, j)
        car = lane(own.rig.car, k)
        if car.closed == 0.0:
            if finish_if_stopped(own, _cases_of(trains, j), train, k):
                car.closed = 1.0
            else:
                all_stand = False
    if all_stand:
        for j in range(len(couplers)):
            copy_from_lane(trains.couplers[train, j], lane(couplers, k)[j])
    return all_stand
