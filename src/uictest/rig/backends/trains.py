"""The code of the rig for a stop of several cars, compiled when a train is first run."""

from functools import cache
from typing import Any, Final

from uictest.controllers import EXCHANGE
from uictest.core import lanes
from uictest.core.lanes import translate
from uictest.core.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.rig.backends.compiled import compile_inner, scalar_model
from uictest.rig.backends.machine_code import Entries, Unit, address, native_function
from uictest.rig.model.couplers import COUPLER
from uictest.rig.model.parameters import PARAMETERS
from uictest.rig.model.rail import RAIL_MEMORY, ROWS
from uictest.rig.model.state import BOGIE, CAR, WHEELSET
from uictest.rig.model.trace import TRAIN_SAMPLE, WHEELSET_SAMPLE, Trace
from uictest.rig.model.wheelset_parameters import WHEELSET_PARAMETERS

_RUN: Final = "uictest_run_train"
_LAYOUTS: Final = (
    *(CAR, BOGIE, WHEELSET, PARAMETERS, WHEELSET_PARAMETERS, "f8", COUPLER, "f8", RAIL_MEMORY),
    *(STOP_MEASURES, WHEELSET_MEASURES, TRAIN_SAMPLE, WHEELSET_SAMPLE),
)
_RUN_ARGUMENTS: Final = (*_LAYOUTS, int, int, int, int)
"""Addresses of the arrays of :func:`uictest.rig.model.train.run_train` in their order; then the number of
cars, points of the rail, rows that a trace has room for, steps per sample."""

STEP: Final = "uictest_step_train"
"""Name of the function that carries a stop of a train on by one cycle."""
STEP_ARGUMENTS: Final = (
    *(CAR, BOGIE, WHEELSET, PARAMETERS, RAIL_MEMORY, STOP_MEASURES, WHEELSET_MEASURES, EXCHANGE),
    *(TRAIN_SAMPLE, WHEELSET_SAMPLE, COUPLER),
    *(int, WHEELSET_PARAMETERS, "f8", "f8", int, TRAIN_SAMPLE, WHEELSET_SAMPLE, int, int, int),
)
"""Its arguments: addresses of the parts of :func:`uictest.rig.backends.stepped_train.train_memory`, number of
cars; addresses of the wheelsets' parameters, the distances and the rail, points of the rail; addresses of a
trace, rows that it has room for, steps per sample, rows that are filled. It returns the rows filled
afterwards."""


@cache
def compiled_train() -> Any:
    """Return :func:`uictest.rig.model.train.run_train` compiled, for arrays of numpy."""
    native = native_function(TRAINS, _RUN, len(_RUN_ARGUMENTS))

    def run_train(*arguments: Any) -> int:
        *arrays, steps_per_sample = arguments
        cars, rail, train_samples = arrays[0], arrays[7], arrays[11]
        n, points, rows = len(cars), rail.shape[-1], train_samples.shape[-1]
        shapes = (
            *((n,), (2 * n,), (4 * n,), (n,), (4 * n,), (n,), (n - 1,), (ROWS, points), (n,)),
            *((n,), (4 * n,), (n, rows), (n, rows, 4)),
        )
        addresses = (
            address(array, layout, shape)
            for array, layout, shape in zip(arrays, _LAYOUTS, shapes, strict=True)
        )
        return native(*addresses, n, points, rows, steps_per_sample)

    return run_train


def _entries() -> Entries:
    """Return the functions of addresses and lengths."""
    from uictest.rig.model.train import run_train, step_train

    run, step = (translate(function, compile_inner, scalar_model()) for function in (run_train, step_train))
    return {
        _RUN: (_run_on_addresses(run), _RUN_ARGUMENTS),
        STEP: (_step_on_addresses(step), STEP_ARGUMENTS),
    }


def _run_on_addresses(entry: Any) -> Any:
    carray = lanes.carray

    def on_addresses(
        cars: Any,
        bogies: Any,
        wheelsets: Any,
        parameters: Any,
        wheelset_parameters: Any,
        distances: Any,
        couplers: Any,
        rail: Any,
        memories: Any,
        measures: Any,
        wheelset_measures: Any,
        train_samples: Any,
        wheelset_samples: Any,
        n: int,
        points: int,
        rows: int,
        steps_per_sample: int,
    ) -> Any:
        return entry(
            carray(cars, n),
            carray(bogies, 2 * n),
            carray(wheelsets, 4 * n),
            carray(parameters, n),
            carray(wheelset_parameters, 4 * n),
            carray(distances, n),
            carray(couplers, n - 1),
            carray(rail, (ROWS, points)),
            carray(memories, n),
            carray(measures, n),
            carray(wheelset_measures, 4 * n),
            carray(train_samples, (n, rows)),
            carray(wheelset_samples, (n, rows, 4)),
            steps_per_sample,
        )

    return on_addresses


def _step_on_addresses(entry: Any) -> Any:
    carray = lanes.carray

    def on_addresses(
        cars: Any,
        bogies: Any,
        wheelsets: Any,
        parameters: Any,
        memories: Any,
        measures: Any,
        wheelset_measures: Any,
        exchanges: Any,
        present_train: Any,
        present_wheelsets: Any,
        couplers: Any,
        n: int,
        wheelset_parameters: Any,
        distances: Any,
        rail: Any,
        points: int,
        train_samples: Any,
        wheelset_samples: Any,
        room: int,
        steps_per_sample: int,
        rows: int,
    ) -> Any:
        return entry(
            carray(cars, n),
            carray(bogies, 2 * n),
            carray(wheelsets, 4 * n),
            carray(parameters, n),
            carray(wheelset_parameters, 4 * n),
            carray(distances, n),
            carray(couplers, n - 1),
            carray(rail, (ROWS, points)),
            carray(memories, n),
            carray(measures, n),
            carray(wheelset_measures, 4 * n),
            carray(exchanges, n),
            Trace(carray(present_train, (n, 1)), carray(present_wheelsets, (n, 1, 4))),
            carray(train_samples, (n, room)),
            carray(wheelset_samples, (n, room, 4)),
            steps_per_sample,
            rows,
        )

    return on_addresses


TRAINS = Unit("uictest_trains", {_RUN: "the rig for trains", STEP: "the rig for trains in steps"}, _entries)
