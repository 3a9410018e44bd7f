"""Signals that ask the program to stop: Ctrl-C, a cancelled job, a terminal that is closed."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable
from types import FrameType

_INTERRUPTED = 2
_ASKING = ("SIGINT", "SIGTERM", "SIGHUP")


def leave_when_asked() -> None:
    """Leave the process at once: nothing is begun yet, and an exception could be lost in an import."""
    _handle(_leave)


def raise_when_asked() -> None:
    """Raise KeyboardInterrupt, so that what is finished is reported and the rest tidied up."""
    _handle(signal.default_int_handler)


def _handle(handler: Callable[[int, FrameType | None], object]) -> None:
    for name in _ASKING:
        number = getattr(signal, name, None)  # Windows has no SIGHUP
        # What the caller wants ignored stays so: nohup ignores SIGHUP.
        if number is not None and signal.getsignal(number) != signal.SIG_IGN:
            signal.signal(number, handler)


def _leave(number: int, frame: FrameType | None) -> None:
    os.write(2, b"uictest: interrupted\n")
    os._exit(_INTERRUPTED)
