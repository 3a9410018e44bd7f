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
