"""What comes before all else: streams that the caller has closed, and signals that ask to stop."""

from __future__ import annotations

import importlib
import os
import signal
import sys
from collections.abc import Callable
from importlib import import_module
from types import FrameType, ModuleType
from typing import Any


def open_closed_streams() -> None:
    """Open streams that the caller has closed (`>&-`) on the null device.

    Otherwise the next file that is opened gets the free number, and messages are written into it.
    """
    for number, name, mode in ((0, "stdin", "r"), (1, "stdout", "w"), (2, "stderr", "w")):
        if _is_closed(number):
            null_device = os.open(os.devnull, os.O_RDWR)  # the lowest number that is free: this one
            setattr(sys, name, open(null_device, mode, encoding="utf-8", closefd=False))  # noqa: SIM115


def _is_closed(number: int) -> bool:
    try:
        os.fstat(number)
    except OSError:
        return True
    return False


def defer_metadata() -> None:
    """Let :mod:`importlib.metadata` be loaded by the first use of it.

    pydantic imports it and then, its plug-ins being disabled, calls nothing of it.
    """
    name = "importlib.metadata"
    deferred = ModuleType(name)

    def loaded() -> Any:
        if sys.modules.get(name) is deferred:
            del sys.modules[name]
        return import_module(name)

    def attribute(wanted: str) -> Any:
        if wanted.startswith("__"):  # asked by whoever looks through all modules
            raise AttributeError(wanted)
        return getattr(loaded(), wanted)

    vars(deferred).update(
        __getattr__=attribute,
        __path__=[os.path.join(folder, "metadata") for folder in importlib.__path__],  # noqa: PTH118
        entry_points=lambda **selected: loaded().entry_points(**selected),
    )
    if name not in sys.modules:
        sys.modules[name] = deferred
        vars(importlib)["metadata"] = deferred


_INTERRUPTED = 2
_ASKING = ("SIGINT", "SIGTERM", "SIGHUP")


def leave_when_asked() -> None:
    """Exit at once on a signal: nothing has begun, and an import could swallow an exception."""
    _handle(_leave)


def raise_when_asked() -> None:
    """Raise KeyboardInterrupt on a signal, so that finished cases are reported and files are cleaned up."""
    _handle(signal.default_int_handler)


def _handle(handler: Callable[[int, FrameType | None], object]) -> None:
    for name in _ASKING:
        number = getattr(signal, name, None)  # Windows has no SIGHUP
        # Signals that the caller ignores stay ignored: nohup ignores SIGHUP.
        if number is not None and signal.getsignal(number) != signal.SIG_IGN:
            signal.signal(number, handler)


def _leave(number: int, frame: FrameType | None) -> None:
    os.write(2, b"uictest: interrupted\n")
    os._exit(_INTERRUPTED)
