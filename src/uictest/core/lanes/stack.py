"""Where compiled code puts the registers that it has no room for."""

from typing import Any

from llvmlite import ir
from numba.core import types

from uictest.core.lanes.compiler import in_compiled_code, local_variable
from uictest.core.lanes.types import vector_of_llvm

_CACHE_LINE = 64
_NUMBERS = _CACHE_LINE // 8


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
