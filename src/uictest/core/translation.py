"""Copies of functions that call copies: one plain source serves numbers and arrays of them."""

import dis
from collections.abc import Callable
from types import FunctionType
from typing import Any, Final, cast

Function = Callable[..., Any]
Wrap = Callable[[Function], Any]
_OWN_PACKAGE: Final = __package__.partition(".")[0]


def translate(function: Function, wrap: Wrap, done: dict[Function, Any]) -> Any:
    """Return ``function`` wrapped, calling wrapped copies of the functions of this package that it calls.

    ``done`` holds what is translated already; entries put there beforehand replace a function by another.
    """
    if function not in done:
        plain = cast(FunctionType, function)
        names = {
            name: translate(plain.__globals__[name], wrap, done)
            for name in _global_names(plain)
            if _is_own(plain.__globals__.get(name))
        }
        copy = FunctionType(plain.__code__, {**plain.__globals__, **names}, plain.__name__)
        copy.__module__ = plain.__module__
        copy.__qualname__ = plain.__qualname__
        done[function] = wrap(copy)
    return done[function]


def _global_names(function: FunctionType) -> set[str]:
    """Names that the function looks up in its module; attributes of the same name do not count."""
    return {step.argval for step in dis.get_instructions(function) if step.opname == "LOAD_GLOBAL"}


def _is_own(value: object) -> bool:
    return isinstance(value, FunctionType) and value.__module__.partition(".")[0] == _OWN_PACKAGE
