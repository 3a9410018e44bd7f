"""The compiled stop: made once by numba, kept as machine code in the cache, called by address."""

from __future__ import annotations

import importlib
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uictest.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.rig.backends.compiled import OPTIONS, callback, compiled_operations, translate
from uictest.rig.backends.machine_code import address, is_kept, native_function
from uictest.rig.model.records import BOGIE, CAR, PARAMETERS, WHEELSET
from uictest.rig.model.stop import run_stop
from uictest.rig.model.trace import ROW

_NAME = "uictest_stop"
_ARGUMENTS = (
    *(CAR, BOGIE, WHEELSET, PARAMETERS, "f8", int),
    *(STOP_MEASURES, WHEELSET_MEASURES, "f8", int, int),
)


@cache
def compiled_stop() -> NativeStop:
    """Return :func:`uictest.rig.model.stop.stop` compiled; the first call on a machine takes some seconds."""
    return NativeStop()


def is_warm() -> bool:
    """Whether the compiled rig lies in the cache, so that the first case starts at once."""
    return is_kept(_NAME)


class NativeStop:
    """The stop of `rig.model.stop` in machine code. It releases the interpreter's lock while it runs."""

    def __init__(self) -> None:
        self._stop = native_function(_NAME, _callback, len(_ARGUMENTS))

    def __call__(
        self,
        car: Any,
        bogies: Any,
        wheelsets: Any,
        p: Any,
        rail: NDArray[np.float64],
        measures: Any,
        wheelset_measures: Any,
        trace: NDArray[np.float64],
        steps_per_sample: int,
    ) -> int:
        """Run one stop on zeroed records. Raises TypeError where one is not laid out as the code takes it."""
        return self._stop(
            address(car, CAR),
            address(bogies, BOGIE, (2,)),
            address(wheelsets, WHEELSET, (4,)),
            address(p, PARAMETERS),
            address(rail, np.dtype("f8"), (4, rail.shape[1])),
            rail.shape[1],
            address(measures, STOP_MEASURES),
            address(wheelset_measures, WHEELSET_MEASURES, (4,)),
            address(trace, np.dtype("f8"), (len(trace), ROW)),
            len(trace),
            steps_per_sample,
        )


def _callback() -> Any:
    """Return the stop compiled by numba, as a function of addresses and the lengths behind them."""
    numba: Any = importlib.import_module("numba")  # its functions have no types
    carray = numba.carray
    entry = translate(run_stop, numba.njit(**OPTIONS), compiled_operations())

    def on_addresses(
        car: Any,
        bogies: Any,
        wheelsets: Any,
        p: Any,
        rail: Any,
        points: int,
        measures: Any,
        wheelset_measures: Any,
        trace: Any,
        rows: int,
        steps_per_sample: int,
    ) -> Any:
        return entry(
            carray(car, 1)[0],
            carray(bogies, 2),
            carray(wheelsets, 4),
            carray(p, 1)[0],
            carray(rail, (4, points)),
            carray(measures, 1)[0],
            carray(wheelset_measures, 4),
            carray(trace, (rows, ROW)),
            steps_per_sample,
        )

    return callback(on_addresses, *_ARGUMENTS)
