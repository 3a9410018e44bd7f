"""The command line, from streams that the caller has closed and signals that ask to stop to its exit code."""

from __future__ import annotations

# An interrupt while this module is loaded still shows Python's traceback, so it imports little.
import atexit
import gc
import os
import signal
import sys
from collections.abc import Callable
from types import FrameType

__all__ = ["main"]


def main() -> None:
    """Run the command line and leave the process with its exit code."""
    leave_when_asked()
    open_closed_streams()
    _start_lightly()
    from uictest.cli.entry import execute

    try:
        raise_when_asked()
        code = int(execute(sys.argv[1:]))
    except KeyboardInterrupt:
        # A second interrupt, while the first was being handled.
        code = 2
    # Everything is written by now, and tearing down all that is loaded takes four tenths of the time of a
    # run. Temporary files, such as those of an FMU in this process, are removed.
    atexit._run_exitfuncs()
    os._exit(code)


def _start_lightly() -> None:
    # Nothing here multiplies large matrices, but numpy's BLAS would start a thread per core.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    # Nor has anything here a use for plug-ins of pydantic, for which it would search all that is installed.
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    # What imports and stops make is hardly ever garbage: a run of one stop, which makes a million objects,
    # ends before the first search of them.
    gc.set_threshold(2_000_000)


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
