"""The command line."""

from __future__ import annotations

import gc
import os
import signal
import sys
from typing import NoReturn

__all__ = ["main"]


def main() -> NoReturn:
    """Run the command line and leave the process with its exit code."""
    _start_lightly()
    # A CI server or a batch system that cancels a job asks in this way first.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        from uictest.cli.entry import execute

        code = int(execute(sys.argv[1:]))
    except KeyboardInterrupt:
        # Pressed before the program was fully imported: what maps errors to codes may not be there yet.
        sys.stderr.write("uictest: interrupted\n")
        code = 2
    # Everything is written by now. Tearing down numba's interpreter state would take longer than a stop does.
    os._exit(code)


def _start_lightly() -> None:
    # Nothing here multiplies large matrices, and numpy's BLAS would start a thread per core to wait for that.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    # What imports make stays: to look through it for garbage every few hundred objects is in vain.
    gc.set_threshold(100_000)
