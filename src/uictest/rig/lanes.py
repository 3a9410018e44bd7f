"""Many stops on one core, several at a time in the lanes of a SIMD register."""

from collections.abc import Sequence
from functools import cache
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.core.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.rig.kernel.arguments import Length, at, block, block_layout
from uictest.rig.kernel.library import WIDTHS, Entry, native_function, processors, register_width
from uictest.rig.model.parameters import PARAMETERS, WHEELSET_PARAMETERS
from uictest.rig.model.rail import FRICTIONS, RAIL_MEMORY, ROWS
from uictest.rig.model.state import BOGIE, CAR, COUPLER, MODULE_STEP, WHEELSET
from uictest.rig.queue import Blank, Lanes, Queue, Trains
from uictest.rig.train_stop import TrainInputs, note_track_brakes_beside

_OF_CAR: Final = ((CAR, 1), (BOGIE, 2), (WHEELSET, 4))
"""Records of the state of one car and how many there are."""
_BLOCKS: Final = (*_OF_CAR, (PARAMETERS, 1), (STOP_MEASURES, 1), (WHEELSET_MEASURES, 4))
"""Records of each car in a lane, besides what it keeps of a controller cycle."""
_BRAKED_ADHESION, _LEAST_ADHESION = 0.12, 0.01
"""Adhesion that full service uses on a better rail, and least adhesion that is assumed; chosen."""


class BatchMeasures(NamedTuple):
    """Measures of many stops, in the order of the cases.

    Attributes:
        measures: records of :data:`uictest.core.measures.STOP_MEASURES`, shape (cases,).
        wheelset_measures: records of :data:`uictest.core.measures.WHEELSET_MEASURES`, shape (cases, 4).
    """

    measures: NDArray[Any]
    wheelset_measures: NDArray[Any]


class TrainMeasures(NamedTuple):
    """Measures of one stop of a train of n cars.

    Attributes:
        measures: records of :data:`uictest.core.measures.STOP_MEASURES`, shape (n,).
        wheelset_measures: records of :data:`uictest.core.measures.WHEELSET_MEASURES`, shape (n, 4).
        couplers: records of :data:`~uictest.rig.model.state.COUPLER`, one behind each car but the last.
    """

    measures: NDArray[Any]
    wheelset_measures: NDArray[Any]
    couplers: NDArray[Any]


def run_in_lanes(
    parameters: NDArray[Any],
    wheelset_parameters: NDArray[Any],
    rail: NDArray[np.float64],
    width: int | None = None,
) -> BatchMeasures:
    """Run the stop of every case; each gives the same bits as alone, whatever its neighbours.

    Other threads may run batches of their own meanwhile.

    Args:
        parameters: records of :data:`~uictest.rig.model.parameters.PARAMETERS`, shape (cases,).
        wheelset_parameters: records of
            :data:`~uictest.rig.model.parameters.WHEELSET_PARAMETERS`, shape (cases, 4).
        rail: friction of the cases' rails, the rows of :mod:`~uictest.rig.model.rail`, shape
            (cases, 4, n).
        width: number of lanes; by default as many as this processor's registers hold.
    """
    cases = len(parameters)
    trains = Trains(
        np.ascontiguousarray(parameters).reshape(1, cases),
        np.ascontiguousarray(wheelset_parameters).reshape(1, cases, 4),
        np.ascontiguousarray(rail),
        np.zeros((1, cases)),
        np.zeros((cases, 0), COUPLER),
        np.zeros((1, cases), STOP_MEASURES),
        np.zeros((1, cases, 4), WHEELSET_MEASURES),
    )
    # Lanes begin their controller cycles together, so that all must have the same number of steps in one.
    steps_per_cycle = parameters["steps_per_cycle"]
    for steps in np.unique(steps_per_cycle):
        _run_queue(trains, np.flatnonzero(steps_per_cycle == steps), width)
    return BatchMeasures(trains.measures[0], trains.wheelset_measures[0])


def run_trains_in_lanes(trains: Sequence[TrainInputs], width: int | None = None) -> list[TrainMeasures]:
    """Run the stop of every train; each gives the same bits as alone, whatever its neighbours.

    Trains of different numbers of cars may be mixed. Other threads may run trains of their own meanwhile.

    Args:
        trains: their inputs, :func:`~uictest.rig.train_assembly.assemble_train`.
        width: number of lanes; by default as many as this processor's registers hold.
    """
    # The trains of a queue begin their controller cycles together, and are blocks of as many cars.
    kinds = [(len(train.parameters), int(train.parameters["steps_per_cycle"][0])) for train in trains]
    done: dict[int, TrainMeasures] = {}
    for kind in sorted(set(kinds)):
        numbers = [number for number, other in enumerate(kinds) if other == kind]
        batch = _trains_in_arrays([trains[number] for number in numbers])
        _run_queue(batch, np.arange(len(numbers)), width)
        note_track_brakes_beside(batch.measures)
        for k, number in enumerate(numbers):
            done[number] = TrainMeasures(
                batch.measures[:, k].copy(), batch.wheelset_measures[:, k].copy(), batch.couplers[k].copy()
            )
    return [done[number] for number in range(len(trains))]


def _trains_in_arrays(trains: Sequence[TrainInputs]) -> Trains:
    cars, points = len(trains[0].parameters), max(train.rail.shape[-1] for train in trains)
    rail = np.zeros((len(trains), ROWS, points))
    for k, train in enumerate(trains):
        rail[k, :, : train.rail.shape[-1]] = train.rail
    return Trains(
        np.stack([train.parameters for train in trains], axis=1),
        np.stack([train.wheelset_parameters for train in trains], axis=1),
        rail,
        np.stack([train.distances for train in trains], axis=1),
        np.stack([train.couplers for train in trains]),
        np.zeros((cars, len(trains)), STOP_MEASURES),
        np.zeros((cars, len(trains), 4), WHEELSET_MEASURES),
    )


def _run_queue(trains: Trains, numbers: NDArray[np.int64], width: int | None) -> None:
    """Fill the measures of some trains, whose controller cycles have as many steps, and of their couplers."""
    width = width or register_width()
    order = _longest_first(trains.parameters[0], trains.rail, numbers)
    cars, steps = len(trains.parameters), int(trains.parameters["steps_per_cycle"][0, order[0]])
    blank = Blank(*(np.zeros(number, layout) for layout, number in _OF_CAR))
    running, memories = np.empty(width, np.int64), np.empty((cars, width), RAIL_MEMORY)
    counts = [(layout, cars * number) for layout, number in _BLOCKS]
    counts += [(MODULE_STEP, 4 * cars * steps), (COUPLER, cars - 1)]
    lanes = Lanes(*(block(layout, width, count) for layout, count in counts))
    _compiled_queue(width)(Queue(lanes, blank, trains, order, running, memories))


def _longest_first(
    parameters: NDArray[Any], rail: NDArray[np.float64], cases: NDArray[np.int64]
) -> NDArray[np.int64]:
    """Return cases in the order in which their stops would end last if speed and friction alone decided.

    A long stop that begins last would run alone, its neighbours idle.
    """
    adhesion = np.minimum(rail[cases, FRICTIONS].mean(axis=-1), _BRAKED_ADHESION)
    expected = parameters["initial_speed"][cases] / np.maximum(adhesion, _LEAST_ADHESION)
    return cases[np.argsort(-expected, kind="stable")]


@cache
def _compiled_queue(width: int) -> Any:
    variants = {WIDTHS[level]: level for level in processors()}
    if width not in variants:
        raise ValueError(f"{width} lanes: on this processor it is {', '.join(map(str, variants))}")
    return native_function(entry(width), variants[width])


def entry(width: int) -> Entry:
    """Return the loop over a queue of trains in blocks of so many lanes."""
    cars, trains, points = Length("cars"), Length("trains"), Length("points")

    def of_lanes(layout: Any, count: int | Length) -> Any:
        return at(block_layout(layout, width), count)

    counts = [(layout, number * cars) for layout, number in _BLOCKS]
    counts += [(MODULE_STEP, Length("module steps")), (COUPLER, cars - 1)]
    lanes = Lanes(*(of_lanes(layout, count) for layout, count in counts))
    given = Trains(
        *(at(PARAMETERS, cars, trains), at(WHEELSET_PARAMETERS, cars, trains, 4)),
        *(at("f8", trains, ROWS, points), at("f8", cars, trains), at(COUPLER, trains, cars - 1)),
        *(at(STOP_MEASURES, cars, trains), at(WHEELSET_MEASURES, cars, trains, 4)),
    )
    queue = Queue(
        *(lanes, Blank(*(at(layout, number) for layout, number in _OF_CAR)), given),
        *(at("i8", Length("queued")), at("i8", Length("lanes")), at(RAIL_MEMORY, cars, Length("lanes"))),
    )
    return Entry("uictest.rig.queue:run_queue", (queue,))
