"""What simulates the cases of a block: the lanes of this processor, or a GPU."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

Device = Literal["cpu", "cuda"]
Measures = tuple[NDArray[Any], NDArray[Any]]
Simulate = Callable[[NDArray[Any], NDArray[np.float64]], Measures]
"""Records and friction laws of some cases to the measures of their stops, shapes (cases,) and (cases, 4)."""


class NoDeviceError(Exception):
    """The device is not in this machine, or cannot be reached; the message says why."""


def simulator(device: Device) -> Simulate:
    """Return what simulates on a device; the first call compiles the rig for it.

    Raises NoDeviceError; ImportError without the extra of the device.
    """
    if device == "cuda":
        return _on_gpu()
    from uictest.rig.lanes import run_batch

    return run_batch


def _on_gpu() -> Simulate:
    from uictest.rig.cuda import cuda, run_batch

    try:
        cuda.current_context()
    except cuda.CudaSupportError as error:
        raise NoDeviceError(_why(error)) from error
    return run_batch


def _why(error: Exception) -> str:
    """Return the first line that says something: numba puts one of its own above what the driver says."""
    text = str(error).removeprefix("Error at driver init:").strip()
    return text.partition("\n")[0].rstrip(".:") or type(error).__name__


def is_warm() -> bool:
    """Return whether the lanes lie compiled in the cache, so that the first part starts at once."""
    from uictest.rig import lanes

    return lanes.is_warm()
