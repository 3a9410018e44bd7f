"""What simulates the cases of a block: the lanes of this processor, or a GPU."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from uictest import rig

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
    return rig.run_in_lanes


def _on_gpu() -> Simulate:
    try:
        rig.cuda.current_context()
    except rig.cuda.CudaSupportError as error:
        raise NoDeviceError(_why(error)) from error
    return rig.run_on_gpu


def _why(error: Exception) -> str:
    """Return the first line that says something: numba puts one of its own above what the driver says."""
    text = str(error).removeprefix("Error at driver init:").strip()
    return text.partition("\n")[0].rstrip(".:") or type(error).__name__


def is_warm() -> bool:
    """Return whether the lanes lie compiled in the cache, so that the first part starts at once."""
    return rig.lanes_are_warm()
