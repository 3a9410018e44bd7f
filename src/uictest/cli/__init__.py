"""The command line."""

# Whoever stops the program while this module is loaded still sees Python's traceback: it imports little.
import gc
import os
import sys

__all__ = ["main"]


def main() -> None:
    """Run the command line and leave the process with its exit code."""
    from uictest.cli.closed_streams import open_closed_streams
    from uictest.cli.signals import leave_when_asked, raise_when_asked

    leave_when_asked()
    open_closed_streams()
    _start_lightly()
    from uictest.cli.entry import execute

    try:
        raise_when_asked()
        code = int(execute(sys.argv[1:]))
    except KeyboardInterrupt:
        # Asked a second time, while the first was being answered.
        code = 2
    # Everything is written by now. Tearing down numba's interpreter state would take longer than a stop does.
    os._exit(code)


def _start_lightly() -> None:
    # Nothing here multiplies large matrices, and numpy's BLAS would start a thread per core to wait for that.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    # What imports make stays: to look through it for garbage every few hundred objects is in vain.
    gc.set_threshold(100_000)
