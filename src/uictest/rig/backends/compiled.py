"""The rig compiled: the same functions, translated once.

:func:`~uictest.lanes.translate` copies a function and everything of this package that it calls, with each
copy wrapped by a compiler. The originals stay plain Python, and one source serves several targets. Floating
point is strict: nothing is contracted but what the source writes as one operation, nothing reassociated, so
that compiled and plain code give the same bits.
"""

import importlib
import sys
from collections.abc import Callable
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np

from uictest import lanes
from uictest.controllers import EXCHANGE, OUTPUTS_AT, Controller
from uictest.lanes import translate as translate
from uictest.physics import fma
from uictest.rig.model.controller import begin, decide
from uictest.rig.model.external_controller import call_step, exchange_at

Function = Callable[..., Any]
Wrap = Callable[[Function], Any]
_SOURCES = (
    "record.py",
    *("physics", "controllers", "faults", "lanes", "rig"),
    *(f"measures/{name}.py" for name in ("records", "layouts", "train", "wheelset")),
    *(f"measures/{name}.py" for name in ("build_up", "contact", "reaction", "sliding_share")),
)
"""Files and rooms of the package that compiled code is made from."""
OPTIONS: dict[str, Any] = {"error_model": "numpy", "nogil": True, "forceinline": True}


def compiled_operations() -> dict[Function, Any]:
    """Return what takes the place of plain functions in code compiled for the processor."""
    return dict(_operations())  # a translation adds to it what it has translated


@cache
def _operations() -> dict[Function, Any]:
    fused = {fma: lanes.fma} if lanes.fuses() else {}
    return {**fused, exchange_at: lanes.record_at(EXCHANGE), call_step: step_by_address()}


def step_by_address() -> Any:
    """Return :func:`uictest.rig.model.external_controller.call_step` in compiled code."""
    call = lanes.call

    def call_at(step: int, handle: int, exchange: int) -> Any:
        return call(step, handle, exchange, exchange + OUTPUTS_AT)

    return compile_inner(call_at)


def with_controller(
    controller: Controller, wrap: Wrap, operations: dict[Function, Any]
) -> dict[Function, Any]:
    """Return replacements for :func:`translate` that put a controller in its place in the model.

    ``operations`` are replacements that hold within the controller, too.
    """
    done = dict(operations)
    functions = translate(controller.begin, wrap, done), translate(controller.decide, wrap, done)
    return {**done, begin: functions[0], decide: functions[1]}


def compile_inner(function: Function) -> Any:
    """Compile a function that only compiled code calls."""
    return lanes.compile_inner(function, **OPTIONS)


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
