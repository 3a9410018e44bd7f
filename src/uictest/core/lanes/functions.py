"""Functions of compiled code: of vectors, where each lane gets what scalar code computes; by addresses."""

import platform
from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba.core import types

from uictest.core.lanes.block import CACHE_LINE
from uictest.core.lanes.compiler import in_compiled_code, local_variable
from uictest.core.lanes.operators import call_llvm, common_integers, common_vector, everywhere, spread
from uictest.core.lanes.types import Mask, Vector, type_of_layout, vector_of_llvm

_POINTER = ir.IntType(8).as_pointer()
_NUMBERS = CACHE_LINE // 8
"""Double-precision numbers in a cache line."""


@in_compiled_code
def select(typing: Any, condition: Any, when_true: Any, when_false: Any) -> Any:
    """Choose one of two values in each lane of a mask; the result is whole where both are."""
    if not isinstance(condition, Mask):
        return None
    whole = common_integers(when_true, when_false)
    result = whole or Vector(condition.width)
    if result.width != condition.width or not (
        whole or common_vector(result, when_true, when_false) == result
    ):
        return None
    fill = everywhere if whole else spread

    def lower(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        choices = (
            fill(context, builder, value, kind, result.width)
            for value, kind in zip(args[1:], sig.args[1:], strict=True)
        )
        return builder.select(args[0], *choices)

    return result(condition, when_true, when_false), lower


def _smaller_or_larger(comparison: str, a: Any, b: Any) -> Any:
    """``a`` where the comparison of the two holds, else ``b``."""
    result = common_vector(a, b)
    if result is None:
        return None

    def lower(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        x, y = (
            spread(context, builder, value, kind, result.width)
            for value, kind in zip(args, sig.args, strict=True)
        )
        return builder.select(builder.fcmp_ordered(comparison, x, y), x, y)

    return result(a, b), lower


@in_compiled_code
def minimum(typing: Any, a: Any, b: Any) -> Any:
    """Smaller number of each lane (``b`` where they cannot be ordered)."""
    return _smaller_or_larger("<", a, b)


@in_compiled_code
def maximum(typing: Any, a: Any, b: Any) -> Any:
    """Larger number of each lane (``b`` where they cannot be ordered)."""
    return _smaller_or_larger(">", a, b)


@in_compiled_code
def fma(typing: Any, a: Any, b: Any, c: Any) -> Any:
    """Product of ``a`` and ``b`` plus ``c``, rounded once: of numbers, or in each lane.

    It takes long where the processor has no instruction for it, see :func:`uictest.core.lanes.block.fuses`.
    """
    of_numbers = all(isinstance(kind, types.Float | types.Integer) for kind in (a, b, c))
    result = types.float64 if of_numbers else common_vector(a, b, c)
    if result is None:
        return None

    def lower(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        terms = (
            context.cast(builder, value, kind, result) for value, kind in zip(args, sig.args, strict=True)
        )
        return call_llvm(builder, "fma", *terms)

    return result(a, b, c), lower


def _rounded(function: str, x: Any) -> Any:
    """LLVM's function of that name, whose result is rounded correctly."""
    if not isinstance(x, Vector):
        return None
    return x(x), lambda context, builder, sig, args: call_llvm(builder, function, args[0])


@in_compiled_code
def sqrt(typing: Any, x: Any) -> Any:
    """Square root of each lane, correctly rounded."""
    return _rounded("sqrt", x)


@in_compiled_code
def floor(typing: Any, x: Any) -> Any:
    """Largest whole number not above that of each lane."""
    return _rounded("floor", x)


def record_at(layout: Any) -> Any:
    """Return a function of an address that gives the record of a layout that lies there."""
    record = type_of_layout(layout)

    @in_compiled_code
    def at(typing: Any, address: Any) -> Any:
        if not isinstance(address, types.Integer):
            return None

        def lower(context: Any, builder: Any, sig: Any, args: Any) -> Any:
            return builder.inttoptr(args[0], context.get_value_type(record))

        return record(types.int64), lower

    return at


@in_compiled_code
def call(typing: Any, function: Any, first: Any, second: Any, third: Any) -> Any:
    """Call a C function of three pointers by its address; it returns a whole number of 32 bits.

    The modes of floating point, such as the rounding mode, are afterwards as they were before.
    """
    if not all(isinstance(kind, types.Integer) for kind in (function, first, second, third)):
        return None

    def lower(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        kind = ir.FunctionType(ir.IntType(32), [_POINTER] * 3)
        pointers = [builder.inttoptr(each, _POINTER) for each in args[1:]]
        put_back = _keep_modes(builder)
        status = builder.call(builder.inttoptr(args[0], kind.as_pointer()), pointers)
        put_back()
        return builder.sext(status, ir.IntType(64))

    return types.int64(types.int64, types.int64, types.int64, types.int64), lower


def _keep_modes(builder: Any) -> Callable[[], object]:
    """Emit what reads the control register of floating point; return what emits its restoration."""

    def call_llvm_of(name: str, result: Any, *values: Any) -> Any:
        kind = ir.FunctionType(result, [each.type for each in values])
        return builder.call(builder.module.declare_intrinsic(name, (), kind), values)

    machine = platform.machine().lower()
    if machine in ("aarch64", "arm64"):
        modes = call_llvm_of("llvm.aarch64.get.fpcr", ir.IntType(64))
        return lambda: call_llvm_of("llvm.aarch64.set.fpcr", ir.VoidType(), modes)
    if machine in ("x86_64", "amd64"):
        modes = builder.bitcast(local_variable(builder, ir.IntType(32)), _POINTER)
        call_llvm_of("llvm.x86.sse.stmxcsr", ir.VoidType(), modes)
        return lambda: call_llvm_of("llvm.x86.sse.ldmxcsr", ir.VoidType(), modes)
    return lambda: None  # who calls it puts them back after the stop


@in_compiled_code
def align_stack(typing: Any) -> Any:
    """Let the function that calls this put registers aside on whole cache lines.

    The compiler does so only in functions with a variable that asks for it; elsewhere a register of eight
    numbers lies across two lines, and each time takes twice as long to write and to read.
    """

    def lower(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        variable = local_variable(builder, vector_of_llvm(_NUMBERS))
        variable.align = CACHE_LINE
        # No instruction at all, but one that names the variable: without a use it would be optimised away.
        keep = ir.FunctionType(ir.VoidType(), [variable.type])
        builder.asm(keep, "", "r", [variable], side_effect=True)
        return context.get_dummy_value()

    return types.void(), lower
