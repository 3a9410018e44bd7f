"""Types of the compiler for records, under names as short as a digest.

The compiler writes the name of a type into the name of each function that has one, and numba names a record
by all its fields: most of the code that it hands on would be names.
"""

from hashlib import sha256
from typing import Any

import numpy as np
from numba.core import types
from numba.extending import models, register_model
from numba.np.numpy_support import from_dtype
from numpy.typing import NDArray


class Layout(types.Record):
    """Record whose name is a digest of its fields."""

    def __init__(self, fields: Any, size: int, aligned: bool) -> None:
        super().__init__(fields, size, aligned)
        self.name = f"Record({sha256(self.name.encode()).hexdigest()[:12]})"

    def __repr__(self) -> str:
        return self.name


register_model(Layout)(models.RecordModel)


def type_of_layout(layout: Any) -> Any:
    """Return the compiler's type of a layout as numpy writes it, structured or of plain numbers."""
    kind = from_dtype(np.dtype(layout))
    if not isinstance(kind, types.Record):
        return kind
    fields = [(name, {"type": each.type, "offset": each.offset}) for name, each in kind.fields.items()]
    return Layout(fields, kind.size, kind.aligned)


def type_of_argument(argument: Any) -> Any:
    """Return the type of an argument of C: the address of a layout, or a whole number for `int`."""
    return types.int64 if argument is int else types.CPointer(type_of_layout(argument))  # type: ignore[no-untyped-call]


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
