"""Memory and functions that compiled code is given by their addresses."""

from typing import Any

from llvmlite import ir
from numba.core import types

from uictest.core.lanes.compiler import in_compiled_code, local_variable
from uictest.core.lanes.types import type_of_layout, vector_of_llvm

_POINTER = ir.IntType(8).as_pointer()
_CACHE_LINE = 64
_NUMBERS = _CACHE_LINE // 8


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
    """Call a C function of three pointers by its address; it returns a whole number of 32 bits."""
    if not all(isinstance(kind, types.Integer) for kind in (function, first, second, third)):
        return None

    def lower(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        kind = ir.FunctionType(ir.IntType(32), [_POINTER] * 3)
        pointers = [builder.inttoptr(each, _POINTER) for each in args[1:]]
        status = builder.call(builder.inttoptr(args[0], kind.as_pointer()), pointers)
        return builder.sext(status, ir.IntType(64))

    return types.int64(types.int64, types.int64, types.int64, types.int64), lower


@in_compiled_code
def align_stack(typing: Any) -> Any:
    """Let the function that calls this put registers aside on whole cache lines.

    The compiler does so only in functions with a variable that asks for it; elsewhere a register of eight
    numbers lies across two lines, and each time takes twice as long to write and to read.
    """

    def lower(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        variable = local_variable(builder, vector_of_llvm(_NUMBERS))
        variable.align = _CACHE_LINE
        # No instruction at all, but one that names the variable: without a use it would be optimised away.
        keep = ir.FunctionType(ir.VoidType(), [variable.type])
        builder.asm(keep, "", "r", [variable], side_effect=True)
        return context.get_dummy_value()

    return types.void(), lower
