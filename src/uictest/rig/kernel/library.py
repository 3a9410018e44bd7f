"""The functions of the kernel, by the level of the processor that runs them."""

import ctypes
import importlib
import os
import platform
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, Final, NamedTuple

from uictest.rig.kernel.arguments import Arguments, digest_of_layouts, leaves, lengths, passed
from uictest.rig.kernel.built import Built, KernelError

FOLDER: Final = Path(__file__).parent
SUFFIX: Final = {"win32": "dll", "darwin": "dylib"}.get(sys.platform, "so")
WIDTHS: Final = {"v1": 2, "v3": 4, "v4": 8}
"""Numbers in a register, by the level of x86-64 that the code is for; other processors have v1 only."""
RIG: Final = Built(FOLDER, "rig", SUFFIX, (), "the kernel", f"{platform.system()} {platform.machine()}")
PROCESSOR: Final = "UICTEST_PROCESSOR"
"""Variable that names one of these levels in place of the processor's own."""


class Entry(NamedTuple):
    """A function of the kernel that Python calls.

    Attributes:
        function: where its formula stands, as ``module:function``.
        arguments: what it takes.
    """

    function: str
    arguments: Arguments

    @property
    def symbol(self) -> str:
        """Its name in the library, without that of the processor; it has the digest of what it takes."""
        return f"uictest_{self.function.partition(':')[2]}_{digest_of_layouts(self.arguments)}"

    def target(self) -> Any:
        """Return the Python function."""
        module, _, name = self.function.partition(":")
        return getattr(importlib.import_module(module), name)


def native_function(entry: Entry, level: str | None = None) -> Callable[..., int]:
    """Return a function of the kernel.

    It is called with what its arguments describe: arrays, records, named tuples of them, whole numbers. It
    releases the interpreter's lock while it runs, and raises TypeError where an array or a record does not
    have the compiled layout or shape. Arguments as for :func:`function_of_addresses`.
    """
    function = function_of_addresses(entry, level)
    return lambda *values: function(*passed(entry.arguments, values))


@cache
def function_of_addresses(entry: Entry, level: str | None = None) -> Callable[..., int]:
    """Return the same function, to be called with what :func:`.passed` returns. Raises KernelError.

    Args:
        entry: the function.
        level: of the processor that its code is for; None: the highest that this one has.
    """
    count = len(lengths(entry.arguments)) + sum(1 for _ in leaves(entry.arguments))
    prototype = ctypes.CFUNCTYPE(ctypes.c_int64, *[ctypes.c_int64] * count)
    try:
        return prototype((f"{entry.symbol}_{level or processor()}", _library()))
    except AttributeError:  # code for other records would write beyond these
        changed = "the records of the rig were changed after this process had loaded them; start it again"
        raise KernelError(changed) from None


def register_width() -> int:
    """Return how many double-precision numbers a register of this processor holds."""
    return WIDTHS[processor()]


@cache
def processor() -> str:
    """Return the level of the processor whose code is run. Raises KernelError."""
    named = os.environ.get(PROCESSOR) or processors()[-1]
    if named not in processors():
        raise KernelError(f"{PROCESSOR}={named}: this processor runs {', '.join(processors())}")
    return named


@cache
def processors() -> tuple[str, ...]:
    """Return the levels whose code this processor can run."""
    best: int = _library().uictest_processor()
    return tuple(level for level in WIDTHS if int(level[1:]) <= best)


@cache
def _library() -> Any:
    path = RIG.path()
    try:
        return ctypes.CDLL(str(path))
    except OSError as error:
        raise KernelError(f"{path} cannot be loaded on {platform.platform()}: {error}") from error
