"""Lanes: stops side by side in the registers of a processor, one number of each in a register.

A block holds records of several stops, each field as one number per lane. Of a block, compiled code takes
:func:`vectors`, whose attributes are registers, or one :func:`lane`, whose attributes are numbers: what
branches or looks up tables runs lane by lane, the rest in all lanes at once. Every operation rounds as its
scalar counterpart does: a lane gives the bits that a stop alone gives, whatever its neighbours hold and
however wide the register is.
"""

from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

CACHE_LINE = 64
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
    size = count * block_layout(layout, width).itemsize
    memory = np.zeros(size + CACHE_LINE, np.uint8)
    start = -memory.ctypes.data % CACHE_LINE
    return memory[start : start + size].view(block_layout(layout, width))


def block_layout(layout: np.dtype[Any], width: int) -> np.dtype[Any]:
    """Return the layout of a record of a block."""
    names = [name for name in layout.names or () if not layout[name].shape]
    return np.dtype([(name, layout[name], (width,)) for name in names])


def vectors(block: Any) -> Any:
    """Records of a block with all lanes at once as attributes; ``[i]`` gives the i-th."""
    _compiled_only()


def lane(block: Any, number: int) -> Any:
    """Records of a block as lane ``number`` holds them, numbers as attributes; ``[i]`` gives the i-th."""
    _compiled_only()


def copy_to_lane(place: Any, record: Any) -> None:
    """Set every field of one lane's record to that of an ordinary record, which must have them all."""
    _compiled_only()


def copy_from_lane(record: Any, place: Any) -> None:
    """Set those fields of an ordinary record that one lane's record has; it must have them all."""
    _compiled_only()


def _compiled_only() -> NoReturn:
    raise TypeError("the code of lanes runs compiled only; the model of one stop also runs in plain Python")
