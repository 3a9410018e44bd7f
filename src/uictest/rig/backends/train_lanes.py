"""Many trains on one core, several at a time in the lanes of a SIMD register; compiled when first run."""

from collections.abc import Callable, Sequence
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.core.lanes import Length, at, block, register_width, translate
from uictest.core.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.rig.backends.compiled import compile_inner
from uictest.rig.backends.lane_records import Trains
from uictest.rig.backends.lanes import (
    BLANK,
    blank_rig,
    lane_arguments,
    lane_blocks,
    lane_model,
    longest_first,
)
from uictest.rig.backends.machine_code import Entry, Unit, is_kept, native_function
from uictest.rig.model.couplers import COUPLER
from uictest.rig.model.parameters import PARAMETERS
from uictest.rig.model.rail import RAIL_MEMORY, ROWS
from uictest.rig.model.wheelset_parameters import WHEELSET_PARAMETERS
from uictest.rig.train_measures import note_track_brakes_beside
from uictest.rig.train_stop import TrainInputs


class TrainMeasures(NamedTuple):
    """Measures of one stop of a train of n cars.

    Attributes:
        measures: records of :data:`uictest.core.measures.STOP_MEASURES`, shape (n,).
        wheelset_measures: records of :data:`uictest.core.measures.WHEELSET_MEASURES`, shape (n, 4).
        couplers: records of :data:`~uictest.rig.model.couplers.COUPLER`, one behind each car but the last.
    """

    measures: NDArray[Any]
    wheelset_measures: NDArray[Any]
    couplers: NDArray[Any]


def run_trains_in_lanes(trains: Sequence[TrainInputs], width: int | None = None) -> list[TrainMeasures]:
    """Run the stop of every train; each gives the same bits as alone, whatever its neighbours.

    Trains of different numbers of cars may be mixed. Other threads may run trains of their own meanwhile. The
    first call on a machine compiles the lanes, within half a minute.

    Args:
        trains: their inputs, :func:`~uictest.rig.train_inputs.assemble_train`.
        width: number of lanes; by default as many as this processor's registers hold.
    """
    # The trains of a queue begin their controller cycles together, and are blocks of as many cars.
    kinds = [(len(train.parameters), int(train.parameters["steps_per_cycle"][0])) for train in trains]
    done: dict[int, TrainMeasures] = {}
    for kind in sorted(set(kinds)):
        numbers = [number for number, other in enumerate(kinds) if other == kind]
        batch = _batch([trains[number] for number in numbers])
        _run_queue(batch, width or register_width())
        note_track_brakes_beside(batch.measures)
        for place, number in enumerate(numbers):
            done[number] = TrainMeasures(
                batch.measures[:, place].copy(),
                batch.wheelset_measures[:, place].copy(),
                batch.couplers[place].copy(),
            )
    return [done[number] for number in range(len(trains))]


def _batch(trains: Sequence[TrainInputs]) -> Trains:
    cars, points = len(trains[0].parameters), max(train.rail.shape[-1] for train in trains)
    rail = np.zeros((len(trains), ROWS, points))
    for place, train in enumerate(trains):
        rail[place, :, : train.rail.shape[-1]] = train.rail
    return Trains(
        np.stack([train.parameters for train in trains], axis=1),
        np.stack([train.wheelset_parameters for train in trains], axis=1),
        rail,
        np.stack([train.distances for train in trains], axis=1),
        np.stack([train.couplers for train in trains]),
        np.zeros((cars, len(trains)), STOP_MEASURES),
        np.zeros((cars, len(trains), 4), WHEELSET_MEASURES),
    )


def _run_queue(batch: Trains, width: int) -> None:
    """Fill the measures of a batch and the ledgers of its couplers."""
    n, trains = batch.parameters.shape
    queue = longest_first(batch.parameters[0], batch.rail, np.arange(trains))
    steps = int(batch.parameters["steps_per_cycle"][0, 0])
    load_train_lanes(width)(
        *(lane_blocks(n, steps, width), block(COUPLER, width, n - 1), blank_rig(), batch),
        *(queue, np.empty(width, np.int64), np.empty((n, width), RAIL_MEMORY)),
    )


def train_lanes_are_compiled() -> bool:
    """Return whether the cache holds the loop over a queue of trains."""
    _, entry = _code(register_width())
    return is_kept(entry)


def load_train_lanes(width: int | None = None) -> Callable[..., int]:
    """Return the loop over a queue of trains in machine code, compiled first where the cache has none."""
    return native_function(*_code(width or register_width()))


@cache
def _code(width: int) -> tuple[Unit, Entry]:
    cars, trains, points = Length("cars"), Length("trains"), Length("points")
    given = Trains(
        *(at(PARAMETERS, cars, trains), at(WHEELSET_PARAMETERS, cars, trains, 4)),
        *(at("f8", trains, ROWS, points), at("f8", cars, trains), at(COUPLER, trains, cars - 1)),
        *(at(STOP_MEASURES, cars, trains), at(WHEELSET_MEASURES, cars, trains, 4)),
    )
    couplers = at(block(COUPLER, width).dtype, cars - 1)
    arguments = (
        *(lane_arguments(cars, width), couplers, BLANK, given),
        *(at("i8", Length("queued")), at("i8", width), at(RAIL_MEMORY, cars, width)),
    )
    entry = Entry(f"uictest_run_trains_{width}", "the rig for many trains at once", arguments)
    return Unit(f"uictest_train_lanes_{width}", (entry,), _functions), entry


def _functions() -> list[Any]:
    from uictest.rig.backends.lane_trains import run_train_queue  # loads numba

    return [translate(run_train_queue, compile_inner, lane_model())]
