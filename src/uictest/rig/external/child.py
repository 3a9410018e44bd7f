"""What a child process does, and how it begins: limited in memory, with a guard.

given cycles, one after the other.

Requests come through standard input, answers go through standard output; what a controller prints goes to
standard error.

python -m uictest.rig.external.child EXCHANGE LIFELINE FOLDER

LIFELINE is a pipe that the parent holds open. When it is closed, however the parent has ended, the guard ends
the child and every process that a controller has started, and removes FOLDER, which has temporary files. It
is a process of its own: a thread of the child would wait for an interpreter that a controller may never
release.
"""

import mmap
import os
import resource
import shutil
import signal
import sys
from contextlib import suppress
from typing import Any, BinaryIO, Final

import numpy as np

from uictest.controllers import EXCHANGE, ControllerError
from uictest.rig.external.block import run_block
from uictest.rig.external.drive import drive_controller
from uictest.rig.external.messages import (
    Message,
    StreamEndedError,
    block_of,
    drive_request_of,
    drives_message,
    finished_message,
    read_message,
    run_message,
    stop_of,
    write_message,
)
from uictest.rig.external.workers import run_in_process


def serve(exchange_file: int) -> None:
    """Answer requests until there are no more.

    Args:
        exchange_file: descriptor of the memory that the parent watches, records of
            :data:`~uictest.controllers.EXCHANGE`.

    """
    requests, answers = _private_streams()
    memory: Any = mmap.mmap(exchange_file, 0)
    if hasattr(mmap, "MADV_DONTFORK"):
        # A copy of this process that a controller forks would run the same stop in the same memory.
        memory.madvise(mmap.MADV_DONTFORK)
    exchanges = np.frombuffer(memory, EXCHANGE)
    while True:
        try:
            request = read_message(requests)
        except StreamEndedError:
            return
        memory[:] = bytes(len(memory))
        answer = _answer(request, exchanges)
        write_message(answers, answer.head, answer.blocks)


def _answer(request: Message, exchanges: Any) -> Message:
    try:
        return _ANSWERS[request.head["request"]](request, exchanges)
    except ControllerError as error:
        return Message({"error": str(error)})


def _stop(request: Message, exchanges: Any) -> Message:
    return finished_message(run_in_process(*stop_of(request), exchanges[0]))


def _block(request: Message, exchanges: Any) -> Message:
    inputs = block_of(request)
    return run_message(run_block(inputs, exchanges[: len(inputs.programs)]))


def _drive(request: Message, exchanges: Any) -> Message:
    return drives_message(drive_controller(drive_request_of(request), exchanges[0]))


_ANSWERS: Final = {"stop": _stop, "block": _block, "drive": _drive}


def _private_streams() -> tuple[BinaryIO, BinaryIO]:
    """Return standard input and output, and leave a controller nothing that it could disturb them with."""
    requests = os.fdopen(os.dup(0), "rb")
    answers = os.fdopen(os.dup(1), "wb")
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.dup2(2, 1)
    os.close(nothing)
    return requests, answers


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
