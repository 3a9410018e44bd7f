"""Lanes: one compiled function steps as many scenarios at once as a SIMD register holds numbers.

Compiled code that is given :func:`vectors` of a block of records reads and writes a whole register where it
names an attribute, and computes with ordinary operators and the functions below. Given one :func:`lane` of
the same block it reads and writes plain numbers: what branches runs lane by lane, what does not runs in all
lanes at once. Every operation rounds as its scalar counterpart does: a lane gives the bits that scalar code
gives, whatever its neighbours hold and however wide the register is.

The room rests on internals of numba and is the only one that does. It knows nothing of the rig. What only
compiled code calls is imported when it is first used, since blocks are filled without a compiler; import it
by name, for numba knows nothing of functions that appear while it compiles.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from uictest.lanes.block import block
from uictest.lanes.host import fuses, register_width

if TYPE_CHECKING:
    from uictest.lanes.functions import floor, fma, maximum, minimum, select, sqrt
    from uictest.lanes.records import lane, put, take, vectors
    from uictest.lanes.stack import align_stack

__all__ = [
    "align_stack",
    "block",
    "floor",
    "fma",
    "fuses",
    "lane",
    "maximum",
    "minimum",
    "put",
    "register_width",
    "select",
    "sqrt",
    "take",
    "vectors",
]

_MODULES = {
    "functions": ("floor", "fma", "maximum", "minimum", "select", "sqrt"),
    "records": ("lane", "put", "take", "vectors"),
    "stack": ("align_stack",),
}


def __getattr__(name: str) -> Any:
    for module, names in _MODULES.items():
        if name in names:
            import_module("uictest.lanes.integers")  # gives whole numbers their operators
            return getattr(import_module(f"uictest.lanes.{module}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
