"""What comes before all else: streams that the caller has closed, and signals that ask to stop."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable
from types import FrameType


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
