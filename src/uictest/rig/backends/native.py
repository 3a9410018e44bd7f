"""The stop in machine code: compiled once per controller by numba, kept in the cache, called by address."""

from collections.abc import Iterable
from functools import cache, partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uictest.controllers import Controller
from uictest.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.rig.backends.compiled import (
    callback,
    compile_inner,
    compiled_operations,
    compiler,
    translate,
    with_controller,
)
from uictest.rig.backends.machine_code import address, is_kept, native_function
from uictest.rig.model.friction_law import ROWS
from uictest.rig.model.parameters import PARAMETERS
from uictest.rig.model.rail_memory import RAIL_MEMORY
from uictest.rig.model.state import BOGIE, CAR, WHEELSET
from uictest.rig.model.stop import run_stop
from uictest.rig.model.trace import TRAIN_SAMPLE, WHEELSET_SAMPLE, Trace
from uictest.rig.model.wheelset_parameters import WHEELSET_PARAMETERS

_ARGUMENTS = (
    *(CAR, BOGIE, WHEELSET, PARAMETERS, WHEELSET_PARAMETERS, "f8", int, RAIL_MEMORY),
    *(STOP_MEASURES, WHEELSET_MEASURES, TRAIN_SAMPLE, WHEELSET_SAMPLE, int, int),
)


def stops_are_compiled(controllers: Iterable[Controller]) -> bool:
    """Return whether the cache holds the stop with each of these controllers."""
    return all(is_kept(_name(controller)) for controller in set(controllers))


def _name(controller: Controller) -> str:
    return f"uictest_stop_{controller.symbol}"


@cache
def compiled_stop(controller: Controller) -> "NativeStop":
    """Return :func:`uictest.rig.model.stop.run_stop` compiled for a controller.

    The first call on a machine takes some fifteen seconds.
    """
    return NativeStop(controller)


class NativeStop:
    """The stop in machine code. It releases the interpreter's lock while it runs."""

    def __init__(self, controller: Controller) -> None:
        self._stop = native_function(_name(controller), partial(_compile, controller), len(_ARGUMENTS))

    def __call__(
        self,
        car: Any,
        bogies: Any,
        wheelsets: Any,
        p: Any,
        wheelset_parameters: Any,
        rail: NDArray[np.float64],
        memory: Any,
        measures: Any,
        wheelset_measures: Any,
        trace: Trace,
        steps_per_sample: int,
    ) -> int:
        """Run one stop on zeroed records. Raises TypeError where one does not have the compiled layout."""
        rows = len(trace.train)
        return self._stop(
            address(car, CAR),
            address(bogies, BOGIE, (2,)),
            address(wheelsets, WHEELSET, (4,)),
            address(p, PARAMETERS),
            address(wheelset_parameters, WHEELSET_PARAMETERS, (4,)),
            address(rail, np.dtype("f8"), (ROWS, rail.shape[1])),
            rail.shape[1],
            address(memory, RAIL_MEMORY),
            address(measures, STOP_MEASURES),
            address(wheelset_measures, WHEELSET_MEASURES, (4,)),
            address(trace.train, TRAIN_SAMPLE, (rows,)),
            address(trace.wheelsets, WHEELSET_SAMPLE, (rows, 4)),
            rows,
            steps_per_sample,
        )


def _compile(controller: Controller) -> Any:
    """Return the stop compiled by numba, as a function of addresses and the lengths behind them."""
    carray = compiler().carray
    model = with_controller(controller, compile_inner, compiled_operations())
    entry = translate(run_stop, compile_inner, model)

    def on_addresses(
        car: Any,
        bogies: Any,
        wheelsets: Any,
        p: Any,
        wheelset_parameters: Any,
        rail: Any,
        points: int,
        memory: Any,
        measures: Any,
        wheelset_measures: Any,
        train_samples: Any,
        wheelset_samples: Any,
        rows: int,
        steps_per_sample: int,
    ) -> Any:
        return entry(
            carray(car, 1)[0],
            carray(bogies, 2),
            carray(wheelsets, 4),
            carray(p, 1)[0],
            carray(wheelset_parameters, 4),
            carray(rail, (ROWS, points)),
            carray(memory, 1)[0],
            carray(measures, 1)[0],
            carray(wheelset_measures, 4),
            Trace(carray(train_samples, rows), carray(wheelset_samples, (rows, 4))),
            steps_per_sample,
        )

    return callback(on_addresses, *_ARGUMENTS)
