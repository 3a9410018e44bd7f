"""Operators of whole numbers in lanes: what counters, commands and a generator of random bits need."""

import operator
from typing import Any

from numba.core import types
from numba.core.typing.templates import AbstractTemplate

from uictest.core.lanes.compiler import code_of, signature, typing_of
from uictest.core.lanes.operators import filled, spread
from uictest.core.lanes.types import Integers, Mask, Vector, integers_of_llvm, vector_of_llvm

_OPERATORS: dict[Any, Any] = {
    operator.add: lambda builder, a, b: builder.add(a, b),
    operator.iadd: lambda builder, a, b: builder.add(a, b),
    operator.mul: lambda builder, a, b: builder.mul(a, b),
    operator.and_: lambda builder, a, b: builder.and_(a, b),
    operator.or_: lambda builder, a, b: builder.or_(a, b),
    operator.xor: lambda builder, a, b: builder.xor(a, b),
    operator.lshift: lambda builder, a, b: builder.shl(a, b),
    operator.rshift: lambda builder, a, b: builder.ashr(a, b),
}
_COMPARISONS: dict[Any, Any] = {
    operator.eq: lambda builder, a, b: builder.icmp_signed("==", a, b),
    operator.lt: lambda builder, a, b: builder.icmp_signed("<", a, b),
}


def _define(function: Any, emit: Any, result: type) -> None:
    """Define ``function`` for two registers of whole numbers, or a register and a whole number."""

    @typing_of(function)
    class _Template(AbstractTemplate):
        def generic(self, args: Any, kws: Any) -> Any:
            integers = common_integers(*args) if len(args) == 2 else None
            return signature(result(integers.width), *args) if integers else None

    def lower(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        width = sig.return_type.width
        a, b = (everywhere(context, builder, x, kind, width) for x, kind in zip(args, sig.args, strict=True))
        return emit(builder, a, b)

    code_of(function, Integers, types.Integer)(lower)
    code_of(function, types.Integer, Integers)(lower)
    code_of(function, Integers, Integers)(lower)


def common_integers(*kinds: Any) -> Integers | None:
    """Type that whole numbers and those of lanes combine to; None when they do not."""
    lane_kinds = {kind for kind in kinds if isinstance(kind, Integers)}
    fits = all(isinstance(kind, Integers | types.Integer) for kind in kinds)
    return lane_kinds.pop() if fits and len(lane_kinds) == 1 else None


def everywhere(context: Any, builder: Any, value: Any, kind: Any, width: int) -> Any:
    """Whole number of type ``kind`` in every lane; those of lanes are left as they are."""
    if isinstance(kind, Integers):
        return value
    return filled(builder, context.cast(builder, value, kind, types.int64), integers_of_llvm(width))


for _function, _emit in _OPERATORS.items():
    _define(_function, _emit, Integers)
for _function, _emit in _COMPARISONS.items():
    _define(_function, _emit, Mask)


@typing_of(operator.add)
class _AddFloat(AbstractTemplate):
    def generic(self, args: Any, kws: Any) -> Any:
        fits = len(args) == 2 and isinstance(args[0], Integers) and isinstance(args[1], types.Float)
        return signature(Vector(args[0].width), *args) if fits else None


@code_of(operator.add, Integers, types.Float)
def _add_float(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    """Whole numbers and a float give floats, as scalars do."""
    width = sig.return_type.width
    whole = builder.sitofp(args[0], vector_of_llvm(width))
    return builder.fadd(whole, spread(context, builder, args[1], sig.args[1], width))
