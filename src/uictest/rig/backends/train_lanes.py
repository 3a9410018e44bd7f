"""Many trains on one core, several at a time in the lanes of a SIMD register; compiled when first run."""

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.core import lanes
from uictest.core.lanes import block, register_width, translate
from uictest.core.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.rig.backends.compiled import compile_inner
from uictest.rig.backends.lanes import RIG, blocks_of, lane_model, longest_first
from uictest.rig.backends.machine_code import Entries, Unit, address, is_kept, native_function
from uictest.rig.model.couplers import COUPLER
from uictest.rig.model.parameters import PARAMETERS
from uictest.rig.model.rail import RAIL_MEMORY, ROWS
from uictest.rig.model.wheelset_parameters import WHEELSET_PARAMETERS
from uictest.rig.train_measures import note_track_brakes_beside
from uictest.rig.train_stop import TrainInputs

_ARGUMENTS: Final = 26
"""How many arguments the compiled loop over a queue of trains has."""


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


class _Batch(NamedTuple):
    """Trains of n cars: arrays of :class:`~uictest.rig.backends.lane_trains.Trains`."""

    parameters: NDArray[Any]
    wheelset_parameters: NDArray[Any]
    rail: NDArray[np.float64]
    distances: NDArray[np.float64]
    couplers: NDArray[Any]
    measures: NDArray[Any]
    wheelset_measures: NDArray[Any]


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


def _batch(trains: Sequence[TrainInputs]) -> _Batch:
    cars, points = len(trains[0].parameters), max(train.rail.shape[-1] for train in trains)
    rail = np.zeros((len(trains), ROWS, points))
    for place, train in enumerate(trains):
        rail[place, :, : train.rail.shape[-1]] = train.rail
    return _Batch(
        np.stack([train.parameters for train in trains], axis=1),
        np.stack([train.wheelset_parameters for train in trains], axis=1),
        rail,
        np.stack([train.distances for train in trains], axis=1),
        np.stack([train.couplers for train in trains]),
        np.zeros((cars, len(trains)), STOP_MEASURES),
        np.zeros((cars, len(trains), 4), WHEELSET_MEASURES),
    )


def _run_queue(batch: _Batch, width: int) -> None:
    """Fill the measures of a batch and the ledgers of its couplers."""
    n, trains = batch.parameters.shape
    queue = longest_first(batch.parameters[0], batch.rail, np.arange(trains))
    steps = int(batch.parameters["steps_per_cycle"][0, 0])
    blocks = blocks_of(n, steps, width)
    blank = [np.zeros(number, layout) for layout, number in RIG]
    allocated = (
        *(*batch, *blocks, block(COUPLER, width, n - 1), *blank),
        *(queue, np.empty(width, np.int64), np.empty((n, width), RAIL_MEMORY)),
    )
    arguments = [address(array, array.dtype, array.shape) for array in allocated]
    load_train_lanes(width)(*arguments, n, trains, batch.rail.shape[-1], queue.size, steps)


def train_lanes_are_compiled() -> bool:
    """Return whether the cache holds the loop over a queue of trains."""
    return is_kept(_name(register_width()))


def load_train_lanes(width: int | None = None) -> Callable[..., int]:
    """Return the loop over a queue of trains in machine code, compiled first where the cache has none."""
    width = width or register_width()
    unit = Unit(
        f"uictest_train_lanes_{width}",
        {_name(width): "the rig for many trains at once"},
        partial(_entries, width),
    )
    return native_function(unit, _name(width), _ARGUMENTS)


def _name(width: int) -> str:
    return f"uictest_run_trains_{width}"


def _entries(width: int) -> Entries:
    """Return the loop over a queue of trains, as a function of addresses and of what lies there."""
    from uictest.rig.backends.lane_cycle import Lanes, RigRecords  # loads numba
    from uictest.rig.backends.lane_trains import Trains, run_train_queue

    carray = lanes.carray
    run_queue = translate(run_train_queue, compile_inner, lane_model())

    def on_addresses(
        parameters: Any,
        wheelset_parameters: Any,
        rail: Any,
        distances: Any,
        coupler_records: Any,
        measures: Any,
        wheelset_measures: Any,
        cars: Any,
        bogies: Any,
        wheelsets: Any,
        settings: Any,
        samples: Any,
        wheelset_samples: Any,
        module_steps: Any,
        couplers: Any,
        blank_car: Any,
        blank_bogies: Any,
        blank_wheelsets: Any,
        queue: Any,
        running: Any,
        memories: Any,
        n: int,
        count: int,
        points: int,
        queued: int,
        steps: int,
    ) -> int:
        run_queue(
            Lanes(
                RigRecords(carray(cars, n), carray(bogies, 2 * n), carray(wheelsets, 4 * n)),
                carray(settings, n),
                carray(samples, n),
                carray(wheelset_samples, 4 * n),
                carray(module_steps, steps * 4 * n),
            ),
            carray(couplers, n - 1),
            RigRecords(carray(blank_car, 1), carray(blank_bogies, 2), carray(blank_wheelsets, 4)),
            Trains(
                carray(parameters, (n, count)),
                carray(wheelset_parameters, (n, count, 4)),
                carray(rail, (count, ROWS, points)),
                carray(distances, (n, count)),
                carray(coupler_records, (count, n - 1)),
                carray(measures, (n, count)),
                carray(wheelset_measures, (n, count, 4)),
            ),
            carray(queue, queued),
            carray(running, width),
            carray(memories, (n, width)),
        )
        return 0

    inputs = PARAMETERS, WHEELSET_PARAMETERS, "f8", "f8", COUPLER, STOP_MEASURES, WHEELSET_MEASURES
    blocks = (each.dtype for each in (*blocks_of(1, 1, width), block(COUPLER, width)))
    blank = (layout for layout, _ in RIG)
    arguments = (*inputs, *blocks, *blank, "i8", "i8", RAIL_MEMORY, int, int, int, int, int)
    return {_name(width): (on_addresses, arguments)}
