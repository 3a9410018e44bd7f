"""The rig compiled: the same functions, translated once.

:func:`translate` copies a function and everything of this package that it calls, with each copy wrapped
by a compiler. The originals stay plain Python, and one source serves several targets. Floating point is
strict: nothing is contracted but what the source writes as one operation, nothing reassociated, so that
compiled and plain code give the same bits.
"""

import dis
import importlib
import sys
from collections.abc import Callable
from functools import cache
from importlib import metadata
from pathlib import Path
from types import FunctionType
from typing import Any, cast

import numpy as np

from uictest import lanes
from uictest.controllers import Controller
from uictest.physics import fma
from uictest.rig.model.controller import begin, decide

Function = Callable[..., Any]
Wrap = Callable[[Function], Any]
_SOURCES = (
    "record.py",
    *("physics", "controllers", "lanes", "rig"),
    *("measures/records.py", "measures/layouts.py", "measures/train.py", "measures/wheelset.py"),
)
"""Files and rooms of the package that compiled code is made from."""
OPTIONS: dict[str, Any] = {"error_model": "numpy", "nogil": True, "forceinline": True}


def compiled_operations() -> dict[Function, Any]:
    """Return what takes the place of plain functions in code compiled for the processor."""
    return {fma: lanes.fma} if lanes.fuses() else {}


def with_controller(
    controller: Controller, wrap: Wrap, operations: dict[Function, Any]
) -> dict[Function, Any]:
    """Return replacements for :func:`translate` that put a controller in its place in the model.

    ``operations`` are replacements that hold within the controller, too.
    """
    done = dict(operations)
    functions = translate(controller.begin, wrap, done), translate(controller.decide, wrap, done)
    return {**done, begin: functions[0], decide: functions[1]}


def translate(function: Function, wrap: Wrap, done: dict[Function, Any]) -> Any:
    """Return ``function`` wrapped, calling wrapped copies of the functions of this package that it calls.

    ``done`` holds what is translated already; entries put there beforehand replace a function by another.
    """
    if function not in done:
        plain = cast(FunctionType, function)
        names = {
            name: translate(plain.__globals__[name], wrap, done)
            for name in _global_names(plain)
            if _is_ours(plain.__globals__.get(name))
        }
        copy = FunctionType(plain.__code__, {**plain.__globals__, **names}, plain.__name__)
        copy.__module__ = plain.__module__
        copy.__qualname__ = plain.__qualname__
        done[function] = wrap(copy)
    return done[function]


def _global_names(function: FunctionType) -> set[str]:
    """Names that the function looks up in its module; attributes of the same name do not count."""
    return {step.argval for step in dis.get_instructions(function) if step.opname == "LOAD_GLOBAL"}


def _is_ours(value: object) -> bool:
    return (
        isinstance(value, FunctionType)
        and value.__module__.partition(".")[0] == __package__.partition(".")[0]
    )


def compiler() -> Any:
    """Return numba, loaded at the first use; its functions have no types."""
    return importlib.import_module("numba")


def callback(function: Function, *arguments: Any) -> Any:
    """Compile a function of addresses and whole numbers, called as C calls it; it returns a whole number.

    Args:
        function: what is compiled.
        arguments: for each argument the layout of what lies at the address, or `int` for a whole number.
    """
    numba = compiler()
    kinds = [
        numba.int64 if each is int else numba.types.CPointer(numba.from_dtype(np.dtype(each)))
        for each in arguments
    ]
    return numba.cfunc(numba.int64(*kinds), **OPTIONS)(function)


@cache
def compiler_inputs() -> bytes:
    """Return everything that compiled code depends on beside the processor: sources, options, versions."""
    versions = (sys.version_info[:2], *(metadata.version(name) for name in ("numba", "llvmlite", "numpy")))
    return b"".join([repr((OPTIONS, versions)).encode(), *(source.read_bytes() for source in sources())])


def sources() -> list[Path]:
    """Return the files that compiled code is made from."""
    package = Path(__file__).parents[2]
    places = [package / name for name in _SOURCES]
    return [file for place in places for file in (sorted(place.rglob("*.py")) if place.is_dir() else [place])]
