"""Records in lanes, for compiled code: attributes that load and store vectors, or the numbers of one lane."""

import operator
from collections.abc import Iterator
from typing import Any

from llvmlite import ir
from numba.core import types
from numba.core.typing.templates import AbstractTemplate, AttributeTemplate, infer_getattr

import uictest.core.lanes.operators  # noqa: F401 - gives whole numbers their operators
from uictest.core.lanes.compiler import (
    code_of,
    code_of_reading,
    code_of_writing,
    in_compiled_code,
    member_of_record,
    signature,
    typing_of,
)
from uictest.core.lanes.types import Integers, LaneType, LaneVectors, LaneView, Vector

_BYTES = 8
"""Of one number, and the alignment that is relied on: a block may lie anywhere."""
_NUMBERS = {types.float64: ir.DoubleType(), types.int64: ir.IntType(64)}


@in_compiled_code
def vectors(typing: Any, block: Any) -> Any:
    """Records of a block (:func:`.block`) with vectors as attributes; ``[i]`` gives the i-th."""
    if not _is_block(block):
        return None

    def lower(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        return _address(context, builder, sig.args[0], args[0])

    return LaneVectors(block.dtype)(block), lower


@in_compiled_code
def lane(typing: Any, block: Any, number: Any) -> Any:
    """Records of a block as lane ``number`` holds them, numbers as attributes; ``[i]`` gives the i-th."""
    if not _is_block(block) or not isinstance(number, types.Integer):
        return None

    def lower(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        return _beyond(builder, _address(context, builder, sig.args[0], args[0]), args[1], _BYTES)

    return LaneView(block.dtype)(block, types.intp), lower


@in_compiled_code
def copy_to_lane(typing: Any, place: Any, record: Any) -> Any:
    """Set every field of one lane's record to that of an ordinary record, which must have them all."""
    if not _has_fields_of(record, place):
        return None

    def lower(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        to, source = sig.args
        for field, kind, member in _members(context, builder, source, args[1], to):
            _write(builder, to, args[0], field, context.unpack_value(builder, kind, member))
        return context.get_dummy_value()

    return types.void(place, record), lower


@in_compiled_code
def copy_from_lane(typing: Any, record: Any, place: Any) -> Any:
    """Set those fields of an ordinary record that one lane's record has; it must have them all."""
    if not _has_fields_of(record, place):
        return None

    def lower(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        to, source = sig.args
        for field, kind, member in _members(context, builder, to, args[0], source):
            context.pack_value(builder, kind, _read(builder, source, args[1], field), member)
        return context.get_dummy_value()

    return types.void(record, place), lower


@typing_of(operator.getitem)
class _Index(AbstractTemplate):
    def generic(self, args: Any, kws: Any) -> Any:
        place, index = args
        fits = isinstance(place, LaneType) and isinstance(index, types.Integer)
        return signature(place, place, types.intp) if fits else None


@code_of(operator.getitem, LaneType, types.Integer)
def _record_at(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    return _beyond(builder, args[0], args[1], sig.args[0].record.size)


@infer_getattr
class _VectorAttributes(AttributeTemplate):
    key = LaneVectors

    def generic_resolve(self, place: Any, field: str) -> Any:  # type: ignore[override]
        kinds = {types.float64: Vector, types.int64: Integers}
        kind = kinds.get(place.number(field))
        return None if kind is None else kind(place.width)


@infer_getattr
class _NumberAttributes(AttributeTemplate):
    key = LaneView

    def generic_resolve(self, place: Any, field: str) -> Any:  # type: ignore[override]
        return place.number(field)


@code_of_reading(LaneType)
def _load(context: Any, builder: Any, place: LaneType, value: Any, field: str) -> Any:
    return _read(builder, place, value, field)


@code_of_writing(LaneType)
def _store(context: Any, builder: Any, sig: Any, args: Any, field: str) -> None:
    _write(builder, sig.args[0], args[0], field, args[1])


def _read(builder: Any, place: LaneType, address: Any, field: str) -> Any:
    value = builder.load(_field(builder, place, address, field), align=_BYTES)
    _mark(builder, value, place, field)
    return value


def _write(builder: Any, place: LaneType, address: Any, field: str, value: Any) -> None:
    write = builder.store(value, _field(builder, place, address, field), align=_BYTES)
    _mark(builder, write, place, field)


def _mark(builder: Any, access: Any, place: LaneType, field: str) -> None:
    """Tell the compiler that an access to a field of a record touches no other field (LLVM's `tbaa`).

    Without that each write makes it read again what it holds in registers.
    """
    module, first = builder.module, ir.Constant(ir.IntType(64), 0)
    root = module.add_metadata([__name__])
    record = module.add_metadata([place.record.name, root, first])
    of_field = module.add_metadata([field, record, first])
    access.set_metadata("tbaa", module.add_metadata([of_field, of_field, first]))


def _has_fields_of(record: Any, place: Any) -> bool:
    """Whether an ordinary record has every field of a lane's record, of the same type."""
    if not isinstance(place, LaneView) or not isinstance(record, types.Record):
        return False
    return all(
        field in record.fields and record.typeof(field) == place.number(field)
        for field in place.record.fields
    )


def _members(
    context: Any, builder: Any, record: Any, address: Any, place: LaneType
) -> Iterator[tuple[str, Any, Any]]:
    """Yield the fields of a lane's record with their types and addresses in an ordinary one."""
    for field in place.record.fields:
        kind = record.typeof(field)
        yield (
            field,
            kind,
            member_of_record(builder, address, record.offset(field), context.get_data_type(kind)),
        )


def _is_block(kind: Any) -> bool:
    return isinstance(kind, types.Array) and isinstance(kind.dtype, types.Record) and kind.layout == "C"


def _address(context: Any, builder: Any, kind: Any, array: Any) -> Any:
    """Address of the first byte of an array."""
    data = context.make_array(kind)(context, builder, array).data
    return builder.bitcast(data, ir.IntType(8).as_pointer())


def _beyond(builder: Any, address: Any, count: Any, size: int) -> Any:
    """Address ``count`` times ``size`` bytes further on."""
    return builder.gep(address, [builder.mul(count, ir.Constant(count.type, size))])


def _field(builder: Any, place: LaneType, address: Any, field: str) -> Any:
    """Address of a field: of its vector, or of the number of one lane."""
    kind = _NUMBERS[place.number(field)]
    if isinstance(place, LaneVectors):
        kind = ir.VectorType(kind, place.width)
    offset = ir.Constant(ir.IntType(64), place.record.offset(field))
    return builder.bitcast(builder.gep(address, [offset]), kind.as_pointer())
