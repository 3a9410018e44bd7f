"""In compiled code: what a function of C is given, as the arrays, records and tuples of its description."""

from collections.abc import Iterator
from typing import Any

from llvmlite import ir
from numba.core import types

from uictest.core.lanes.arguments import Arguments, At, leaves, lengths
from uictest.core.lanes.compiler import emit_array, signature
from uictest.core.lanes.types import type_of_layout

_tuple_of: Any = types.BaseTuple.from_types


def kind_of(argument: Any) -> Any:
    """Return the compiler's type of an argument."""
    if argument is int:
        return types.int64
    if isinstance(argument, tuple):
        return _tuple_of(tuple(map(kind_of, argument)), type(argument))
    record = type_of_layout(argument.layout)
    return types.Array(record, len(argument.shape), "C") if argument.shape else record


def parameters_of_c(context: Any, arguments: Arguments) -> list[ir.Type]:
    """Return LLVM's types of what the function of C takes, :func:`~uictest.core.lanes.arguments.passed`."""
    kinds = (each if each is int else _pointer(each) for each in leaves(arguments))
    whole = context.get_value_type(types.int64)
    rest = [whole if each is int else context.get_value_type(each) for each in kinds]
    return [whole] * len(lengths(arguments)) + rest


def given_values(context: Any, builder: Any, arguments: Arguments, given: Any) -> list[Any]:
    """Return the values of arguments for what the function of C is given."""
    names, rest = lengths(arguments), iter(given)
    numbers = {name: next(rest) for name in names}
    return [_value(context, builder, each, rest, numbers) for each in arguments]


def _value(context: Any, builder: Any, argument: Any, given: Iterator[Any], numbers: dict[str, Any]) -> Any:
    if argument is int:
        return next(given)
    kind = kind_of(argument)
    if isinstance(argument, tuple):
        members = [_value(context, builder, each, given, numbers) for each in argument]
        return context.make_tuple(builder, kind, members)
    if not argument.shape:
        return builder.bitcast(next(given), context.get_value_type(kind))
    shape = _tuple_of((types.intp,) * len(argument.shape))
    sizes = [_size(builder, each, numbers) for each in argument.shape]
    of_array = signature(kind, _pointer(argument), shape)
    return emit_array(context, builder, of_array, (next(given), context.make_tuple(builder, shape, sizes)))


def _size(builder: Any, size: Any, numbers: dict[str, Any]) -> Any:
    whole = ir.IntType(64)
    if isinstance(size, int):
        return whole(size)
    multiple = builder.mul(numbers[size.name], whole(size.factor))
    return builder.sub(multiple, whole(size.less))


def _pointer(argument: At) -> Any:
    return types.CPointer(type_of_layout(argument.layout))  # type: ignore[no-untyped-call]
