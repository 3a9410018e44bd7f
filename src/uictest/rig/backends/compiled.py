"""The rig compiled: the same functions, translated once.

:func:`~uictest.core.lanes.translate` copies a function and everything of this package that it calls, with
each copy wrapped by a compiler. The originals stay plain Python, and one source serves several targets.
Floating point is strict: nothing is contracted but what the source writes as one operation, nothing
reassociated, so that compiled and plain code give the same bits.
"""

import hashlib
import os
import sys
from collections.abc import Callable, Sequence
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import Any

from uictest.controllers import EXCHANGE, OUTPUTS_AT, Controller
from uictest.core import lanes
from uictest.core.lanes import translate
from uictest.core.physics import fma
from uictest.rig.model.controller import CHOICES, begin, call_step, decide, exchange_at

Function = Callable[..., Any]
Wrap = Callable[[Function], Any]
_SOURCES = (
    *(
        "core/record.py",
        "core/physics",
        "core/rail_laws",
        "core/lanes",
        "controllers",
        "plans/faults.py",
        "rig",
    ),
    *(
        f"core/measures/{name}.py"
        for name in ("records", "layouts", "train", "wheelset", "monitoring", "contact")
    ),
    "core/measures/noted_samples.py",
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
    """Return :func:`uictest.rig.model.controller.call_step` in compiled code."""
    call = lanes.call

    def call_at(step: int, handle: int, exchange: int) -> Any:
        return call(step, handle, exchange, exchange + OUTPUTS_AT)

    return compile_inner(call_at)


@cache
def scalar_model() -> dict[Function, Any]:
    """Return what is translated of the model for one rig at a time, with the controllers in their place.

    Translations are added to it: what one unit of a process has compiled, the next one does not again.
    """
    return with_controllers(CHOICES, compile_inner, compiled_operations())


def with_controllers(
    choices: Sequence[Controller], wrap: Wrap, operations: dict[Function, Any]
) -> dict[Function, Any]:
    """Return replacements for :func:`translate` that put controllers in their place in the model.

    Args:
        choices: in the order of their numbers; the last one also stands for every other number.
        wrap: as for :func:`translate`.
        operations: replacements that hold within the controllers, too.
    """
    done = dict(operations)
    begins = [translate(each.begin, wrap, done) for each in choices]
    decides = [translate(each.decide, wrap, done) for each in choices]
    begin_chosen, decide_chosen = wrap(_beginning(begins[-1])), decides[-1]
    for number in reversed(range(len(choices) - 1)):
        begin_chosen = wrap(_either(number, wrap(_beginning(begins[number])), begin_chosen))
        decide_chosen = wrap(_either(number, decides[number], decide_chosen))
    return {**done, begin: begin_chosen, decide: decide_chosen}


def _beginning(begin_at_speed: Function) -> Function:
    def begin_stop(train: Any, wheelsets: Any, p: Any) -> None:
        begin_at_speed(train, wheelsets, p.initial_speed)

    return begin_stop


def _either(number: int, function: Function, otherwise: Function) -> Function:
    def call_chosen(train: Any, wheelsets: Any, p: Any) -> None:
        if p.controller == number:
            function(train, wheelsets, p)
        else:
            otherwise(train, wheelsets, p)

    return call_chosen


def compile_inner(function: Function) -> Any:
    """Compile a function that only compiled code calls."""
    return lanes.compile_inner(function, **OPTIONS)


@cache
def compiler_inputs() -> bytes:
    """Return a digest of everything that code depends on before it is made for a processor."""
    versions = (sys.version_info[:2], *map(metadata.version, ("numba", "llvmlite", "numpy")))
    digest = hashlib.sha256(repr((OPTIONS, lanes.fuses(), versions)).encode())
    for source in sources():
        with open(source, "rb") as file:  # noqa: PTH123 - a warm start reads them all
            digest.update(hashlib.sha256(file.read()).digest())
    return digest.digest()


def sources() -> list[str]:
    """Return the paths of the files that compiled code is made from."""
    package = str(Path(__file__).parents[2])
    places = [os.path.join(package, *name.split("/")) for name in _SOURCES]  # noqa: PTH118
    return [path for place in places for path in ([place] if place.endswith(".py") else _modules_in(place))]


def _modules_in(folder: str) -> list[str]:
    """Return the modules in a folder and below, in an order that is the same everywhere."""
    with os.scandir(folder) as entries:
        below = sorted((entry.path, entry.is_dir()) for entry in entries if entry.name != "__pycache__")
    inner = (_modules_in(path) if is_folder else [path] for path, is_folder in below)
    return [path for paths in inner for path in paths if path.endswith(".py")]
