"""The compiled stop: made once by numba, kept as machine code in the cache, called by address."""

from __future__ import annotations

import ctypes
import importlib
from functools import cache
from pathlib import Path
from threading import Lock
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uictest.measures import MEASURES, WHEELSET_MEASURES
from uictest.recording import write_bytes_atomic
from uictest.rig.compiled import OPTIONS, cache_folder, compiled_operations, translate, use_cache
from uictest.rig.machine_code import load, object_file, processor
from uictest.rig.records import BOGIE, CAR, PARAMETERS, WHEELSET
from uictest.rig.stop import stop
from uictest.rig.trace import ROW

_NAME = "uictest_stop"
_compiling = Lock()


@cache
def compiled_stop() -> NativeStop:
    """Return :func:`uictest.rig.stop.stop` compiled; the first call on a machine takes some seconds."""
    file = _code_file()
    with _compiling:
        if not file.exists():
            write_bytes_atomic(file, object_file(_callback(), _NAME))
    return NativeStop(file.read_bytes())


def is_warm() -> bool:
    """Whether the compiled rig lies in the cache, so that the first case starts at once."""
    return _code_file().exists()


def _code_file() -> Path:
    return cache_folder() / f"stop-{processor()}.o"


class NativeStop:
    """The stop in machine code, called as :func:`uictest.rig.stop.stop` is; other threads run meanwhile."""

    def __init__(self, code: bytes) -> None:
        self._code = load(code)
        pointer, integer = ctypes.c_void_p, ctypes.c_int64
        arguments = [pointer] * 5 + [integer] + [pointer] * 3 + [integer] * 2
        self._stop = ctypes.CFUNCTYPE(integer, *arguments)(self._code.get_function_address(_NAME))

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
        rows: int = self._stop(
            _address(car, CAR),
            _address(bogies, BOGIE, (2,)),
            _address(wheelsets, WHEELSET, (4,)),
            _address(p, PARAMETERS),
            _address(rail, np.dtype("f8"), (4, rail.shape[1])),
            rail.shape[1],
            _address(measures, MEASURES),
            _address(wheelset_measures, WHEELSET_MEASURES, (4,)),
            _address(trace, np.dtype("f8"), (len(trace), ROW)),
            len(trace),
            steps_per_sample,
        )
        return rows


def _address(values: Any, layout: np.dtype[Any], shape: tuple[int, ...] = ()) -> int:
    """Return where a record or an array begins. Machine code would believe any other layout, too."""
    if values.dtype != layout or values.shape != shape or not values.flags.c_contiguous:
        raise TypeError(f"expected {shape} contiguous {layout}, found {values.shape} {values.dtype}")
    return int(values.__array_interface__["data"][0])


def _callback() -> Any:
    """Return the stop compiled by numba, as a function of addresses and the lengths behind them."""
    use_cache()
    numba: Any = importlib.import_module("numba")  # its functions have no types
    carray, pointer = numba.carray, numba.types.CPointer
    entry = translate(stop, numba.njit(**OPTIONS), compiled_operations())

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

    def records(*layouts: np.dtype[Any]) -> list[Any]:
        return [pointer(numba.from_dtype(layout)) for layout in layouts]

    integer, numbers = numba.int64, pointer(numba.float64)
    state, observed = records(CAR, BOGIE, WHEELSET, PARAMETERS), records(MEASURES, WHEELSET_MEASURES)
    signature = integer(*state, numbers, integer, *observed, numbers, integer, integer)
    return numba.cfunc(signature, **OPTIONS)(on_addresses)
