"""Many stops on one core, several at a time in the lanes of a SIMD register."""

from collections.abc import Callable, Sequence
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.core import lanes as vector_functions
from uictest.core.lanes import Length, at, block, leaves, register_width, translate
from uictest.core.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.core.physics import floor, maximum, minimum, select, sqrt
from uictest.rig.backends.compiled import (
    Function,
    compile_inner,
    compiled_operations,
    with_controllers,
)
from uictest.rig.backends.lane_records import Cases, Lanes, RigRecords
from uictest.rig.backends.machine_code import Entry, Unit, native_function
from uictest.rig.model.controller import CHOICES
from uictest.rig.model.couplers import account_for_coupler, pull_cars, release_couplers
from uictest.rig.model.cycle import (
    command_valves,
    read_common_sensors,
    read_line_sensor,
    read_other_loadcells,
    read_pole_wheels,
)
from uictest.rig.model.disc_brake import warm_discs
from uictest.rig.model.dynamic_brake import brake_dynamically
from uictest.rig.model.faults import let_air_leak
from uictest.rig.model.module_air import follow_tanks, read_line_pressure
from uictest.rig.model.parameters import PARAMETERS
from uictest.rig.model.rail import FRICTIONS, RAIL_MEMORY, ROWS
from uictest.rig.model.state import BOGIE, CAR, MODULE_STEP, WHEELSET
from uictest.rig.model.step import (
    compensate_kept,
    step_modules,
    step_other_calipers,
    step_vehicle,
    take_clamping_forces,
)
from uictest.rig.model.stop_measures import observe_cycle
from uictest.rig.model.track_brake import account_for_magnets, drag_magnets
from uictest.rig.model.wheelset_parameters import WHEELSET_PARAMETERS

RIG = ((CAR, 1), (BOGIE, 2), (WHEELSET, 4))
"""Records of one rig and how many there are."""
BLOCKS = (*RIG, (PARAMETERS, 1), (STOP_MEASURES, 1), (WHEELSET_MEASURES, 4))
"""Records that each lane has, besides what it keeps of a controller cycle."""
BLANK = RigRecords(*(at(layout, number) for layout, number in RIG))
"""Records of a rig that compiled code is given."""
_BRAKED_ADHESION, _LEAST_ADHESION = 0.12, 0.01
"""What full service uses of a better rail, and the least that a rail is taken to have; chosen."""


class BatchMeasures(NamedTuple):
    """Measures of many stops, in the order of the cases.

    Attributes:
        measures: records of :data:`uictest.core.measures.STOP_MEASURES`, shape (cases,).
        wheelset_measures: records of :data:`uictest.core.measures.WHEELSET_MEASURES`, shape (cases, 4).
    """

    measures: NDArray[Any]
    wheelset_measures: NDArray[Any]


def run_in_lanes(
    parameters: NDArray[Any],
    wheelset_parameters: NDArray[Any],
    rail: NDArray[np.float64],
    width: int | None = None,
) -> BatchMeasures:
    """Run the stop of every case; each gives the same bits as alone, whatever its neighbours.

    Other threads may run batches of their own meanwhile. The first batch on a machine takes some seconds
    more, since the lanes are compiled.

    Args:
        parameters: records of :data:`~uictest.rig.model.parameters.PARAMETERS`, shape (cases,).
        wheelset_parameters: records of
            :data:`~uictest.rig.model.wheelset_parameters.WHEELSET_PARAMETERS`, shape (cases, 4).
        rail: friction of the cases' rails, the rows of :mod:`~uictest.rig.model.rail`, shape
            (cases, 4, n).
        width: number of lanes; by default as many as this processor's registers hold.
    """
    parameters, rail = np.ascontiguousarray(parameters), np.ascontiguousarray(rail)
    own = np.ascontiguousarray(wheelset_parameters)
    batch = BatchMeasures(
        np.zeros(parameters.size, STOP_MEASURES), np.zeros((parameters.size, 4), WHEELSET_MEASURES)
    )
    # Lanes begin their controller cycles together, so that all must have the same number of steps in one.
    steps_per_cycle = parameters["steps_per_cycle"]
    for steps in np.unique(steps_per_cycle):
        queue = longest_first(parameters, rail, np.flatnonzero(steps_per_cycle == steps))
        _run_queue(parameters, own, rail, batch, queue, int(steps), width or register_width())
    return batch


def longest_first(
    parameters: NDArray[Any], rail: NDArray[np.float64], cases: NDArray[np.int64]
) -> NDArray[np.int64]:
    """Return cases in the order in which their stops would end last if speed and friction alone decided.

    A long stop that begins last would run alone, its neighbours idle.
    """
    adhesion = np.minimum(rail[cases, FRICTIONS].mean(axis=-1), _BRAKED_ADHESION)
    expected = parameters["initial_speed"][cases] / np.maximum(adhesion, _LEAST_ADHESION)
    return cases[np.argsort(-expected, kind="stable")]


def _run_queue(
    parameters: NDArray[Any],
    wheelset_parameters: NDArray[Any],
    rail: NDArray[np.float64],
    batch: BatchMeasures,
    queue: NDArray[np.int64],
    steps: int,
    width: int,
) -> None:
    load_lanes(width)(
        *(lane_blocks(1, steps, width), blank_rig(), Cases(parameters, wheelset_parameters, rail, *batch)),
        *(queue, np.empty(width, np.int64), np.empty(width, RAIL_MEMORY)),
    )


def blank_rig() -> RigRecords:
    """Return the records of a rig, all zero."""
    return RigRecords(*(np.zeros(number, layout) for layout, number in RIG))


def lane_blocks(cars: int, steps: int, width: int) -> Lanes:
    """Return the blocks of rigs of so many cars, whose controller cycles have so many steps."""
    blocks = [block(layout, width, cars * number) for layout, number in BLOCKS]
    return _lanes([*blocks, block(MODULE_STEP, width, cars * steps * 4)])


def _lanes(blocks: Sequence[Any]) -> Lanes:
    car, bogies, wheelsets, settings, measures, wheelset_measures, module_steps = blocks
    rig = RigRecords(car, bogies, wheelsets)
    return Lanes(rig, settings, measures, wheelset_measures, module_steps)


def lane_arguments(cars: int | Length, width: int) -> Lanes:
    """Return what compiled code takes as the blocks of rigs of so many cars."""
    *records, module_step = (each.dtype for each in leaves(lane_blocks(1, 1, width)))
    counts = (number * cars for _, number in BLOCKS)
    arguments = [at(record, count) for record, count in zip(records, counts, strict=True)]
    return _lanes([*arguments, at(module_step, Length("module steps"))])


def load_lanes(width: int | None = None) -> Callable[..., int]:
    """Return the loop over a queue of cases in machine code, compiled first where the cache has none."""
    return native_function(*_code(width or register_width()))


@cache
def _code(width: int) -> tuple[Unit, Entry]:
    cases, points, queued = Length("cases"), Length("points"), Length("queued")
    given = Cases(
        *(at(PARAMETERS, cases), at(WHEELSET_PARAMETERS, cases, 4), at("f8", cases, ROWS, points)),
        *(at(STOP_MEASURES, cases), at(WHEELSET_MEASURES, cases, 4)),
    )
    arguments = (
        *(lane_arguments(1, width), BLANK, given),
        *(at("i8", queued), at("i8", width), at(RAIL_MEMORY, width)),
    )
    entry = Entry(f"uictest_run_queue_{width}", "the rig for many stops at once", arguments)
    return Unit(f"uictest_lanes_{width}", (entry,), _functions), entry


def _functions() -> list[Any]:
    from uictest.rig.backends.lane_stops import run_queue  # loads numba

    return [translate(run_queue, compile_inner, lane_model())]


@cache
def lane_model() -> dict[Function, Any]:
    """Return what is translated of the model for lanes, to which :func:`translate` adds.

    Functions without branches are translated for all lanes at once, the controllers for one lane. What one
    unit of a process has compiled, the next one does not again.
    """
    in_lanes: dict[Function, Any] = {
        **compiled_operations(),
        select: vector_functions.select,
        minimum: vector_functions.minimum,
        maximum: vector_functions.maximum,
        sqrt: vector_functions.sqrt,
        floor: vector_functions.floor,
    }
    without_branches: tuple[Function, ...] = (
        read_common_sensors,
        read_other_loadcells,
        read_line_sensor,
        read_pole_wheels,
        command_valves,
        read_line_pressure,
        follow_tanks,
        let_air_leak,
        brake_dynamically,
        drag_magnets,
        account_for_magnets,
        step_modules,
        step_other_calipers,
        compensate_kept,
        take_clamping_forces,
        step_vehicle,
        warm_discs,
        observe_cycle,
        release_couplers,
        pull_cars,
        account_for_coupler,
    )
    wide = {function: translate(function, compile_inner, in_lanes) for function in without_branches}
    return {**with_controllers(CHOICES, compile_inner, compiled_operations()), **wide}
