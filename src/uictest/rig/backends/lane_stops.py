"""Stops side by side: each lane runs one, and takes the next from a queue when it has ended.

Compiled only. A lane does what :func:`uictest.rig.model.stop.run_stop` does, cycle by cycle
(:mod:`.lane_cycle`), and its measures have the same bits. Tables of measures are kept lane by lane.
"""

from typing import Any

from uictest.core.lanes import align_stack, copy_from_lane, copy_to_lane, lane
from uictest.rig.backends.lane_cycle import (
    IDLE,
    advance_brake,
    advance_vehicle,
    begin_cycle,
    end_cycle,
)
from uictest.rig.backends.lane_records import Cases, Lanes, RigRecords
from uictest.rig.model.rail import forget_rail
from uictest.rig.model.sand import forget_sand
from uictest.rig.model.start import start
from uictest.rig.model.stop import is_running
from uictest.rig.model.stop_measures import (
    begin_stop_measures,
    begin_tables,
    close_stop_measures,
    keep_tables,
    observe_faults,
    observe_reports,
)


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
    advance_brake(lanes, needs)
    for n in range(needs.steps):
        advance_vehicle(lanes, needs, n)
    end_cycle(lanes, needs)


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
