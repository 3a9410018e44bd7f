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


def simulator(device: Device) -> Simulate:
    """Return what simulates on a device; the first call compiles the rig for it."""
    if device == "cuda":
        from uictest.rig.cuda import run_batch as on_gpu

        return on_gpu
    from uictest.rig.lanes import run_batch

    return run_batch


def is_warm() -> bool:
    """Return whether the lanes lie compiled in the cache, so that the first part starts at once."""
    from uictest.rig.compiled import cache_folder

    return any(cache_folder().glob("**/lane_stops.*.nbc"))
