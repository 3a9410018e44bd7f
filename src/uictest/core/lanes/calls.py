"""Memory and functions that compiled code is given by their addresses."""

from typing import Any

from llvmlite import ir
from numba.core import types

from uictest.core.lanes.compiler import in_compiled_code
from uictest.core.lanes.layouts import type_of_layout

_POINTER = ir.IntType(8).as_pointer()


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
