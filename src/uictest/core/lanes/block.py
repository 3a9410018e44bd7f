"""Blocks of records side by side: the memory that lanes work on."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

_CACHE_LINE = 64
"""Bytes; no vector of a block then lies across two cache lines."""


def block(layout: np.dtype[Any], width: int, count: int = 1) -> NDArray[Any]:
    """Return ``count`` zeroed records of ``width`` lanes each.

    Args:
        layout: structured type of one record; every number takes eight bytes (``f8`` or ``i8``). Fields of
            several numbers are left out: tables are for scalar code.
        width: number of lanes.
        count: number of records, such as the four wheelsets of a car.

    Returns:
        Structured array of shape (count,). Its fields have the names of ``layout`` and hold one number for
        each lane, side by side, so that a field is read into a register at once.
    """
    names = [name for name in layout.names or () if not layout[name].shape]
    wide = np.dtype([(name, layout[name], (width,)) for name in names])
    size = count * wide.itemsize
    memory = np.zeros(size + _CACHE_LINE, np.uint8)
    start = -memory.ctypes.data % _CACHE_LINE
    return memory[start : start + size].view(wide)
