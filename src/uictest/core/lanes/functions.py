"""Functions of vectors, for compiled code: each lane gets what scalar code computes."""

from typing import Any

from numba.core import types

from uictest.core.lanes.compiler import in_compiled_code
from uictest.core.lanes.operators import call_llvm, common_integers, common_vector, everywhere, spread
from uictest.core.lanes.types import Mask, Vector


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
