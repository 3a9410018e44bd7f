"""Stops side by side: each lane runs one, and takes the next from a queue when it has ended.

Compiled only. What branches - controllers, measures - runs lane by lane once per controller cycle; sensors
and the steps between run in all lanes at once. A lane does what :func:`uictest.rig.stop.stop` does, and its
measures have the same bits.
"""

from typing import Any, NamedTuple

from uictest.lanes import align_stack, lane, put, vectors
from uictest.rig.cycle import begin_cycle, sense
from uictest.rig.start import start
from uictest.rig.step import step
from uictest.rig.stop import begin_stop_measures, close_stop_measures, observe_cycle

_IDLE = -1
"""Number of a lane's case when it has none."""


class Rig(NamedTuple):
    """Records of one rig, or blocks of them in lanes: a car, two bogies, four wheelsets."""

    car: Any
    bogies: Any
    wheelsets: Any


class Cases(NamedTuple):
    """What stops are given and the records that take their measures, an entry for each case."""

    parameters: Any
    rail: Any
    measures: Any
    wheelset_measures: Any


def run_queue(rig: Rig, settings: Any, blank: Rig, cases: Cases, queue: Any, running: Any) -> None:
    """Run the cases of ``queue`` in the lanes of ``rig`` and fill their measures.

    Args:
        rig: blocks of lanes (:func:`uictest.lanes.block`).
        settings: block of the parameters in as many lanes.
        blank: records of zeros, with which a lane begins.
        cases: parameters and measures of all cases.
        queue: numbers of the cases to be run, in the order in which they begin; at least one, and all with
            the same number of steps in a controller cycle.
        running: for each lane, the number of its case; set here.
    """
    align_stack()
    begun = 0
    for k in range(running.size):
        # A lane that finds the queue empty steps this case, and so meets no numbers that a case does not.
        _set(rig, settings, blank, cases.parameters[queue[0]], k)
        begun = _take(rig, settings, blank, cases, queue, running, begun, k)
    ended = 0
    while ended < queue.size:
        _run_cycle(rig, settings, cases, running)
        for k in range(running.size):
            if running[k] != _IDLE and _ends(rig, cases, running[k], k):
                ended += 1
                begun = _take(rig, settings, blank, cases, queue, running, begun, k)


def _take(
    rig: Rig,
    settings: Any,
    blank: Rig,
    cases: Cases,
    queue: Any,
    running: Any,
    begun: int,
    k: int,
) -> int:
    """Let lane ``k`` begin the next case, or idle when none waits; return how many have begun."""
    if begun == queue.size:
        running[k] = _IDLE
        return begun
    case = queue[begun]
    running[k] = case
    p = cases.parameters[case]
    _set(rig, settings, blank, p, k)
    begin_stop_measures(lane(rig.car, k), cases.measures[case], cases.wheelset_measures[case], p)
    return begun + 1


def _set(rig: Rig, settings: Any, blank: Rig, p: Any, k: int) -> None:
    """Set lane ``k`` to the instant of the brake command."""
    car, bogies, wheelsets = lane(rig.car, k), lane(rig.bogies, k), lane(rig.wheelsets, k)
    put(lane(settings, k), p)
    put(car, blank.car[0])
    for j in range(2):
        put(bogies[j], blank.bogies[j])
    for i in range(4):
        put(wheelsets[i], blank.wheelsets[i])
    start(car, bogies, wheelsets, p)


def _run_cycle(rig: Rig, settings: Any, cases: Cases, running: Any) -> None:
    """Begin a controller cycle in every lane that runs a case, then step all lanes through it."""
    steps = 0
    sense(vectors(rig.car), vectors(rig.wheelsets), vectors(settings))
    for k in range(running.size):
        case = running[k]
        if case != _IDLE:
            p = cases.parameters[case]
            begin_cycle(lane(rig.car, k), lane(rig.wheelsets, k), p, cases.rail[case])
            steps = p.steps_per_cycle
    for _ in range(steps):
        step(vectors(rig.car), vectors(rig.bogies), vectors(rig.wheelsets), vectors(settings))


def _ends(rig: Rig, cases: Cases, case: int, k: int) -> bool:
    """Take in the end of a cycle of lane ``k``; whether its stop has ended, which completes its measures."""
    p = cases.parameters[case]
    measures, wheelset_measures = cases.measures[case], cases.wheelset_measures[case]
    car, bogies, wheelsets = lane(rig.car, k), lane(rig.bogies, k), lane(rig.wheelsets, k)
    observe_cycle(car, wheelsets, measures, wheelset_measures, p)
    if car.stopped == 0.0 and car.cycle < p.cycles:
        return False
    close_stop_measures(car, bogies, wheelsets, measures, wheelset_measures, p)
    return True
