"""How a child process begins: limited in memory, and with a guard that ends it after its parent.

    python -m uictest.rig.external.guard EXCHANGE LIFELINE FOLDER

LIFELINE is a pipe that the parent holds open. When it is closed, however the parent has ended, the guard ends
the child and every process that a controller has started, and removes FOLDER, which has temporary files. It
is a process of its own: a thread of the child would wait for an interpreter that a controller may never
release.
"""

import os
import resource
import shutil
import signal
import sys
from contextlib import suppress
from typing import Final

MEMORY_LIMIT: Final = 4 * 2**30
"""Most memory of a child, or of a process that its controller starts, bytes; chosen: a child takes some
110 MB, and a controller that leaks is to end before the machine does."""


def leave_guard(lifeline: int, temporary_folder: str) -> None:
    """Fork the guard of this process, which must have no thread yet and be a process group of its own."""
    group = os.getpid()
    if os.fork() != 0:
        os.close(lifeline)
        return
    try:
        # Whoever waits for the child to close its streams must not wait for the guard.
        os.closerange(0, 3)
        os.read(lifeline, 1)
        # The number of the group is not given to others while the guard is in its session.
        os.setpgid(0, 0)
        with suppress(ProcessLookupError):
            os.killpg(group, signal.SIGKILL)
        shutil.rmtree(temporary_folder, ignore_errors=True)
    finally:
        os._exit(0)


def main(exchange_file: int, lifeline: int, temporary_folder: str) -> None:
    """Serve the parent until it closes its end of the requests."""
    leave_guard(lifeline, temporary_folder)
    _, most = resource.getrlimit(resource.RLIMIT_DATA)
    limit = MEMORY_LIMIT if most == resource.RLIM_INFINITY else min(MEMORY_LIMIT, most)
    resource.setrlimit(resource.RLIMIT_DATA, (limit, limit))
    from uictest.rig.external.child import serve  # a fork after numpy's threads have started may hang

    serve(exchange_file)


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]), sys.argv[3])
