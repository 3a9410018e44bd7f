"""Signals that ask the program to stop: Ctrl-C, a cancelled job, a terminal that is closed."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable
from types import FrameType

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
