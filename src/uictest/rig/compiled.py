"""The rig compiled: the same functions, translated once, kept in a cache on disk.

:func:`translate` copies a function and everything of this package that it calls, with each copy wrapped
by a compiler. The originals stay plain Python, and one source serves several targets. Floating point is
strict: nothing is contracted but what the source writes as one operation, nothing reassociated, so that
compiled and plain code give the same bits.
"""

import dis
import hashlib
import importlib
import sys
import tempfile
from collections.abc import Callable
from functools import cache
from importlib import metadata
from pathlib import Path
from types import FunctionType
from typing import Any, cast

from uictest.user_cache import user_cache

Function = Callable[..., Any]
Wrap = Callable[[Function], Any]
_SOURCES = ("physics", "controllers", "measures", "lanes", "rig")
OPTIONS: dict[str, Any] = {"error_model": "numpy", "nogil": True, "forceinline": True}


def compiled_operations() -> dict[Function, Any]:
    """Return what takes the place of plain functions in code compiled for the processor."""
    from uictest import lanes
    from uictest.physics import arithmetic

    return {arithmetic.fma: lanes.fma} if lanes.fuses() else {}


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


@cache
def cache_folder() -> Path:
    """Folder of the compiled rig: one for each state of its sources and of the compiler.

    The compiler itself notices neither an edited callee nor a changed option, so both are part of the
    name. Where the user's cache cannot be written, a folder for this process serves.
    """
    digest = hashlib.sha256(repr((OPTIONS, sys.version_info[:2], metadata.version("numba"))).encode())
    package = Path(__file__).parent.parent
    for room in _SOURCES:
        for source in sorted((package / room).glob("*.py")):
            digest.update(source.read_bytes())
    return user_cache(digest.hexdigest()[:20]) or Path(tempfile.mkdtemp(prefix="uictest-"))


def use_cache() -> None:
    """Point the compiler at our cache folder."""
    _load_without_blas()
    from numba.core import config

    cast(Any, config).CACHE_DIR = str(cache_folder())


def _load_without_blas() -> None:
    """Load the compiler's array functions without scipy's BLAS, which is not needed and slow."""
    blas = "scipy.linalg.cython_blas"
    if "numba.np.arraymath" in sys.modules or blas in sys.modules:
        return
    sys.modules[blas] = None  # type: ignore[assignment]
    try:
        importlib.import_module("numba.np.arraymath")
    finally:
        del sys.modules[blas]
