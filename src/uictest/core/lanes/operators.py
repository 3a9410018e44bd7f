"""Operators of vectors and masks, and of whole numbers in lanes: counters, commands, random bits.

Each is lowered to the instruction that scalar code uses, without licence to reorder or to contract.
"""

import operator
from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba.core import types
from numba.core.typing.templates import AbstractTemplate

from uictest.core.lanes.compiler import code_of, code_of_conversion, signature, typing_of
from uictest.core.lanes.types import Integers, Mask, Vector, integers_of_llvm, vector_of_llvm

Emit = Callable[[Any, Any, Any], Any]

_ARITHMETIC: dict[tuple[Any, Any], Emit] = {
    (operator.add, operator.iadd): lambda builder, a, b: builder.fadd(a, b),
    (operator.sub, operator.isub): lambda builder, a, b: builder.fsub(a, b),
    (operator.mul, operator.imul): lambda builder, a, b: builder.fmul(a, b),
    (operator.truediv, operator.itruediv): lambda builder, a, b: builder.fdiv(a, b),
}
_COMPARISONS: dict[Any, Emit] = {
    operator.lt: lambda builder, a, b: builder.fcmp_ordered("<", a, b),
    operator.le: lambda builder, a, b: builder.fcmp_ordered("<=", a, b),
    operator.gt: lambda builder, a, b: builder.fcmp_ordered(">", a, b),
    operator.ge: lambda builder, a, b: builder.fcmp_ordered(">=", a, b),
}
_LOGIC: dict[Any, Emit] = {
    operator.and_: lambda builder, a, b: builder.and_(a, b),
    operator.or_: lambda builder, a, b: builder.or_(a, b),
}


def spread(context: Any, builder: Any, value: Any, kind: Any, width: int) -> Any:
    """Value of type ``kind`` in every lane; a vector is left as it is."""
    if isinstance(kind, Vector):
        return value
    return filled(builder, context.cast(builder, value, kind, types.float64), vector_of_llvm(width))


def filled(builder: Any, number: Any, vector: ir.VectorType) -> Any:
    """LLVM vector with a number in every lane."""
    nothing = ir.Constant(vector, ir.Undefined)
    first = builder.insert_element(nothing, number, ir.Constant(ir.IntType(32), 0))
    zeros = ir.Constant(ir.VectorType(ir.IntType(32), vector.count), [0] * vector.count)
    return builder.shuffle_vector(first, nothing, zeros)


def common_vector(*kinds: Any) -> Vector | None:
    """Vector type that numbers and vectors of these types combine to; None when they do not."""
    vectors = {kind for kind in kinds if isinstance(kind, Vector)}
    fits = all(isinstance(kind, Vector | types.Float | types.Integer) for kind in kinds)
    return vectors.pop() if fits and len(vectors) == 1 else None


def _define_binary(function: Any, emit: Emit, result: Callable[[int], types.Type]) -> None:
    """Define ``function`` for two vectors, or a vector and a number."""

    @typing_of(function)
    class _Template(AbstractTemplate):
        def generic(self, args: Any, kws: Any) -> Any:
            vector = common_vector(*args) if len(args) == 2 else None
            return signature(result(vector.width), *args) if vector else None

    def lower(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        a, b = (
            spread(context, builder, x, kind, sig.return_type.width)
            for x, kind in zip(args, sig.args, strict=True)
        )
        return emit(builder, a, b)

    for number in (types.Float, types.Integer):
        code_of(function, Vector, number)(lower)
        code_of(function, number, Vector)(lower)
    code_of(function, Vector, Vector)(lower)


def _define_logic(function: Any, emit: Emit) -> None:
    """Define ``function`` for two masks."""

    @typing_of(function)
    class _Template(AbstractTemplate):
        def generic(self, args: Any, kws: Any) -> Any:
            masks = len(args) == 2 and isinstance(args[0], Mask) and args[0] == args[1]
            return signature(args[0], *args) if masks else None

    code_of(function, Mask, Mask)(lambda context, builder, sig, args: emit(builder, *args))


def _define_unary(function: Any, emit: Callable[[Any, Any], Any]) -> None:
    """Define ``function`` for one vector."""

    @typing_of(function)
    class _Template(AbstractTemplate):
        def generic(self, args: Any, kws: Any) -> Any:
            return signature(args[0], args[0]) if len(args) == 1 and isinstance(args[0], Vector) else None

    code_of(function, Vector)(lambda context, builder, sig, args: emit(builder, args[0]))


def call_llvm(builder: Any, name: str, *values: Any) -> Any:
    """LLVM's own function ``name`` of numbers or of vectors."""
    kind = values[0].type
    suffix = f"v{kind.count}f64" if isinstance(kind, ir.VectorType) else "f64"
    function = builder.module.declare_intrinsic(
        f"llvm.{name}.{suffix}", (), ir.FunctionType(kind, [kind] * len(values))
    )
    return builder.call(function, values)


for _functions, _emit in _ARITHMETIC.items():
    for _function in _functions:
        _define_binary(_function, _emit, Vector)
for _function, _emit in _COMPARISONS.items():
    _define_binary(_function, _emit, Mask)
for _function, _emit in _LOGIC.items():
    _define_logic(_function, _emit)
_define_unary(operator.neg, lambda builder, x: builder.fneg(x))
_define_unary(abs, lambda builder, x: call_llvm(builder, "fabs", x))


@code_of_conversion(types.Float, Vector)
@code_of_conversion(types.Integer, Vector)
def _number_to_vector(context: Any, builder: Any, kind: Any, vector: Vector, value: Any) -> Any:
    """A number that is stored into a vector fills every lane."""
    return spread(context, builder, value, kind, vector.width)


_OF_INTEGERS: dict[Any, Any] = {
    operator.add: lambda builder, a, b: builder.add(a, b),
    operator.iadd: lambda builder, a, b: builder.add(a, b),
    operator.mul: lambda builder, a, b: builder.mul(a, b),
    operator.and_: lambda builder, a, b: builder.and_(a, b),
    operator.or_: lambda builder, a, b: builder.or_(a, b),
    operator.xor: lambda builder, a, b: builder.xor(a, b),
    operator.lshift: lambda builder, a, b: builder.shl(a, b),
    operator.rshift: lambda builder, a, b: builder.ashr(a, b),
}
_COMPARISONS_OF_INTEGERS: dict[Any, Any] = {
    operator.eq: lambda builder, a, b: builder.icmp_signed("==", a, b),
    operator.lt: lambda builder, a, b: builder.icmp_signed("<", a, b),
}


def _define_for_integers(function: Any, emit: Any, result: type) -> None:
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


for _function, _emit in _OF_INTEGERS.items():
    _define_for_integers(_function, _emit, Integers)
for _function, _emit in _COMPARISONS_OF_INTEGERS.items():
    _define_for_integers(_function, _emit, Mask)


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
