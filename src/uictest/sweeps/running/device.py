"""Devices that simulate the cases of a block: the SIMD lanes of the processor, or a GPU."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from uictest import rig
from uictest.controllers import Controller

Device = Literal["cpu", "cuda"]
Measures = tuple[NDArray[Any], NDArray[Any]]
Simulate = Callable[[NDArray[Any], NDArray[Any], NDArray[np.float64], Sequence[Controller]], Measures]
"""Simulates cases: records, those of wheelsets, friction laws and controllers to measures.

Their shapes are (cases,) and (cases, 4).
"""


class NoDeviceError(Exception):
    """The device is not in this machine, or cannot be reached; the message gives the reason."""


def simulator(device: Device) -> Simulate:
    """Return the function that simulates on a device; its first call compiles the rig.

    Raises NoDeviceError; ImportError without the extra of the device.
    """
    if device == "cuda":
        return _on_gpu()
    return rig.run_in_lanes


def _on_gpu() -> Simulate:
    try:
        rig.cuda.current_context()
    except rig.cuda.CudaSupportError as error:
        raise NoDeviceError(_driver_message(error)) from error
    return rig.run_on_gpu


def _driver_message(error: Exception) -> str:
    """Return the first line of the driver's message, which numba puts below one of its own."""
    text = str(error).removeprefix("Error at driver init:").strip()
    return text.partition("\n")[0].rstrip(".:") or type(error).__name__
