"""Many stops on one core, several at a time in the lanes of a SIMD register."""

from functools import cache
from threading import Lock
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.measures import MEASURES, WHEELSET_MEASURES
from uictest.physics import arithmetic
from uictest.rig.compiled import OPTIONS, Function, compiled_operations, translate, use_cache
from uictest.rig.records import BOGIE, CAR, PARAMETERS, WHEELSET

_compiling = Lock()


class BatchMeasures(NamedTuple):
    """Measures of many stops, in the order of the cases.

    Attributes:
        measures: records of :data:`uictest.measures.MEASURES`, shape (cases,).
        wheelset_measures: records of :data:`uictest.measures.WHEELSET_MEASURES`, shape (cases, 4).
    """

    measures: NDArray[Any]
    wheelset_measures: NDArray[Any]


def run_batch(parameters: NDArray[Any], rail: NDArray[np.float64], width: int | None = None) -> BatchMeasures:
    """Run the stop of every case; each gives the same bits as alone, whatever its neighbours.

    Other threads may run meanwhile, on batches of their own. The first batch on a machine takes some
    seconds more, for compilation.

    Args:
        parameters: records of :data:`~uictest.rig.records.PARAMETERS`, shape (cases,).
        rail: friction laws of the cases, shape (cases, 4, n): places in m, friction coefficients there, times
            in s, factors then.
        width: number of lanes; by default as many as this processor's registers hold.
    """
    from uictest.lanes import register_width
    from uictest.rig.lane_stops import Cases

    cases = Cases(
        np.ascontiguousarray(parameters),
        np.ascontiguousarray(rail),
        np.zeros(parameters.size, MEASURES),
        np.zeros((parameters.size, 4), WHEELSET_MEASURES),
    )
    for queue in _queues(parameters["steps_per_cycle"]):
        _run_queue(cases, queue, width or register_width())
    return BatchMeasures(cases.measures, cases.wheelset_measures)


def _queues(steps_per_cycle: NDArray[np.int64]) -> list[NDArray[np.int64]]:
    """Numbers of the cases that can run side by side: lanes begin their controller cycles together."""
    return [np.flatnonzero(steps_per_cycle == steps) for steps in np.unique(steps_per_cycle)]


def _run_queue(cases: Any, queue: NDArray[np.int64], width: int) -> None:
    from uictest.lanes import block
    from uictest.rig.lane_stops import Lanes, Rig

    lanes = Lanes(
        Rig(block(CAR, width), block(BOGIE, width, 2), block(WHEELSET, width, 4)),
        block(PARAMETERS, width),
        block(MEASURES, width),
        block(WHEELSET_MEASURES, width, 4),
    )
    blank = Rig(np.zeros(1, CAR), np.zeros(2, BOGIE), np.zeros(4, WHEELSET))
    with _compiling:
        run_queue = _compiled()
    run_queue(lanes, blank, cases, queue, np.empty(width, np.int64))


@cache
def _compiled() -> Any:
    """Return the loop over a queue of cases compiled: what has no branches for lanes, the rest for one."""
    use_cache()
    import numba

    from uictest import lanes
    from uictest.rig.cycle import command_valves, sense
    from uictest.rig.lane_stops import run_queue
    from uictest.rig.step import step
    from uictest.rig.stop import observe_cycle

    njit: Any = numba.njit(**OPTIONS)
    in_lanes: dict[Function, Any] = {
        **compiled_operations(),
        arithmetic.select: lanes.select,
        arithmetic.minimum: lanes.minimum,
        arithmetic.maximum: lanes.maximum,
        arithmetic.sqrt: lanes.sqrt,
        arithmetic.floor: lanes.floor,
    }
    without_branches = (sense, command_valves, step, observe_cycle)
    wide = {function: translate(function, njit, in_lanes) for function in without_branches}
    entry = translate(run_queue, njit, {**compiled_operations(), **wide})
    return numba.njit(**OPTIONS, cache=True)(entry.py_func)
