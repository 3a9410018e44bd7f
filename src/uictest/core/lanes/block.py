"""What lanes rest on: registers of the processor, and blocks of records side by side in memory."""

from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

_WIDTHS = (("avx512f", 8), ("avx", 4))
"""Extensions of x86 and how many double-precision numbers a register of theirs holds."""
_SMALLEST = 2
"""Numbers in a register of SSE2 and of Arm's NEON, which every 64-bit processor of their kind has."""
CACHE_LINE = 64
"""Bytes; no vector of a block then lies across two cache lines."""


@cache
def register_width() -> int:
    """Return how many double-precision numbers a SIMD register of this processor holds."""
    from llvmlite import binding

    features = binding.get_host_cpu_features()
    return next((width for name, width in _WIDTHS if features.get(name)), _SMALLEST)


@cache
def fuses() -> bool:
    """Return whether this processor multiplies and adds in one instruction, as nearly all have since 2013."""
    from llvmlite import binding

    # Where every processor of a kind does so, it is not listed.
    return bool(binding.get_host_cpu_features().get("fma", True))


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
    memory = np.zeros(size + CACHE_LINE, np.uint8)
    start = -memory.ctypes.data % CACHE_LINE
    return memory[start : start + size].view(wide)
