"""The command line."""

# An interrupt while this module is loaded still shows Python's traceback, so it imports little.
import atexit
import gc
import os
import sys

__all__ = ["main"]


def main() -> None:
    """Run the command line and leave the process with its exit code."""
    from uictest.cli.start import leave_when_asked, open_closed_streams, raise_when_asked

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
