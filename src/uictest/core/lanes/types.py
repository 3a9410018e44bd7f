"""Types of the compiler: a register of numbers, its mask, records in lanes and, under short names, records.

The compiler writes the name of a type into the name of each function that has one, and numba names a record
by all its fields: most of the code that it hands on would be names. Records therefore have names as short as
a digest.
"""

from hashlib import sha256
from typing import Any

import numpy as np
from llvmlite import ir
from numba.core import types
from numba.extending import models, register_model
from numba.np.numpy_support import from_dtype


class Vector(types.Type):
    """Register of ``width`` double-precision numbers, one per lane."""

    def __init__(self, width: int) -> None:
        self.width = width
        super().__init__(f"vector(float64 x {width})")


class Integers(types.Type):
    """Register of ``width`` whole numbers of 64 bits, one per lane: counters and random bits."""

    def __init__(self, width: int) -> None:
        self.width = width
        super().__init__(f"vector(int64 x {width})")


class Mask(types.Type):
    """Truth of a comparison in each of ``width`` lanes."""

    def __init__(self, width: int) -> None:
        self.width = width
        super().__init__(f"mask({width})")


class LaneType(types.Type):
    """Place in a block of records side by side.

    As with a pointer in C, a record and a sequence of records are one thing: attributes are those of the
    record at this place, and an index gives the place of another.
    """

    def __init__(self, record: types.Record) -> None:
        self.record = record
        self.width = _width(record)
        super().__init__(f"{type(self).__name__}({record.name})")

    def number(self, field: str) -> Any:
        """Type of one lane's number in a field; None when there is no such field."""
        if field not in self.record.fields:
            return None
        numbers: Any = self.record.typeof(field)
        return numbers.dtype


class LaneVectors(LaneType):
    """Records whose attributes are vectors: all lanes at once."""


class LaneView(LaneType):
    """Records whose attributes are the numbers of one lane."""


def _width(record: types.Record) -> int:
    """Number of lanes: the common length of the record's fields."""
    fields = [record.typeof(name) for name in record.fields]
    shapes = {field.shape for field in fields if isinstance(field, types.NestedArray)}
    if len(shapes) != 1 or not all(isinstance(field, types.NestedArray) for field in fields):
        raise TypeError(f"not a record of lanes: {record.name}")
    ((width,),) = shapes
    return int(width)


def vector_of_llvm(width: int) -> ir.VectorType:
    """LLVM's type of a :class:`Vector`."""
    return ir.VectorType(ir.DoubleType(), width)


def integers_of_llvm(width: int) -> ir.VectorType:
    """LLVM's type of :class:`Integers`."""
    return ir.VectorType(ir.IntType(64), width)


class _Primitive(models.PrimitiveModel):
    """Type that LLVM knows how to keep in a register."""

    def __init__(self, manager: Any, kind: types.Type, kind_of_llvm: ir.Type) -> None:
        super().__init__(manager, kind, kind_of_llvm)  # type: ignore[no-untyped-call]


@register_model(Vector)
class _VectorModel(_Primitive):
    def __init__(self, manager: Any, vector: Vector) -> None:
        super().__init__(manager, vector, vector_of_llvm(vector.width))


@register_model(Integers)
class _IntegersModel(_Primitive):
    def __init__(self, manager: Any, integers: Integers) -> None:
        super().__init__(manager, integers, integers_of_llvm(integers.width))


@register_model(Mask)
class _MaskModel(_Primitive):
    def __init__(self, manager: Any, mask: Mask) -> None:
        super().__init__(manager, mask, ir.VectorType(ir.IntType(1), mask.width))


@register_model(LaneVectors)
@register_model(LaneView)
class _PlaceModel(_Primitive):
    """A place is the address of its first byte."""

    def __init__(self, manager: Any, place: LaneType) -> None:
        super().__init__(manager, place, ir.IntType(8).as_pointer())


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
