"""What an FMU logs: kept for the message of the call that fails, never printed."""

from contextlib import suppress
from ctypes import byref
from importlib import import_module
from threading import local
from typing import Any, Final

import fmpy
from fmpy import fmi2


class _Log(local):
    """The last message of the FMUs of a thread that is not only information."""

    message = ""


_log = _Log()


def clear_log() -> None:
    """Forget what was logged before a call."""
    _log.message = ""


def with_log(text: str) -> str:
    """Return a text, followed by what the FMU has logged last."""
    return f"{text}: {_log.message}" if _log.message else text


def _note(status: int, message: bytes | None) -> None:
    if status > 0:
        _log.message = (message or b"").decode("utf-8", "replace").strip()


def _note_fmi2(environment: Any, instance: bytes, status: int, category: bytes, message: bytes) -> None:
    _note(status, message)


def note_fmi3(environment: Any, status: int, category: bytes, message: bytes) -> None:
    """Keep a message; FMI 3.0 calls this."""
    _note(status, message)


def _callbacks() -> Any:
    callbacks = fmi2.fmi2CallbackFunctions()
    callbacks.logger = fmi2.fmi2CallbackLoggerTYPE(_note_fmi2)
    callbacks.allocateMemory = fmi2.fmi2CallbackAllocateMemoryTYPE(fmpy.calloc)
    callbacks.freeMemory = fmi2.fmi2CallbackFreeMemoryTYPE(fmpy.free)
    with suppress(OSError):  # FMPy has it for some platforms; without it messages keep their placeholders
        import_module("fmpy.logging").addLoggerProxy(byref(callbacks))
    return callbacks


FMI2_CALLBACKS: Final = _callbacks()
"""What FMUs of FMI 2.0 call. FMPy formats messages for one logger only, so there is one for all FMUs."""
