"""What a child process does: it runs stops with controllers from outside, or drives such a controller through
given cycles, one after the other.

Requests come through standard input, answers go through standard output; what a controller prints goes to
standard error.
"""

import mmap
import os
import resource
import sys
from typing import Any, BinaryIO, Final

import numpy as np

from uictest.controllers import EXCHANGE, ControllerError
from uictest.rig.external.drives import drive_controller
from uictest.rig.external.in_process import run_block, run_train_in_process
from uictest.rig.external.messages import (
    Message,
    StreamEndedError,
    block_of,
    drive_request_of,
    drives_message,
    read_message,
    run_message,
    train_of,
    train_stop_message,
    write_message,
)
from uictest.rig.kernel.library import source_digest

MEMORY_LIMIT: Final = 4 * 2**30
"""Most memory of a child, or of a process that its controller starts, bytes; chosen: a child takes some
110 MB, and a controller that leaks is to end before the machine does."""

_CHANGED: Final = "the Python files of uictest were changed while it runs: run it again"


def serve(exchange_file: int, sources: str) -> None:
    """Answer requests until there are no more.

    Args:
        exchange_file: descriptor of the memory that the parent watches, records of
            :data:`~uictest.controllers.EXCHANGE`.
        sources: digest of those that the kernel of the parent was made from.

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
        answer = _answer(request, exchanges) if sources == source_digest() else Message({"error": _CHANGED})
        try:
            write_message(answers, answer)
        except OSError:  # a controller has closed it
            os._exit(os.EX_IOERR)


def _answer(request: Message, exchanges: Any) -> Message:
    try:
        match request.head["request"]:
            case "train":
                inputs, steps_per_sample = train_of(request)
                own_exchanges = exchanges[: len(inputs.from_outside)]
                return train_stop_message(run_train_in_process(inputs, steps_per_sample, own_exchanges))
            case "block":
                block = block_of(request)
                return run_message(run_block(block, exchanges[: len(block.programs)]))
            case _:
                return drives_message(drive_controller(drive_request_of(request), exchanges[0]))
    except ControllerError as error:
        return Message({"error": str(error)})


def _private_streams() -> tuple[BinaryIO, BinaryIO]:
    """Return standard input and output, and leave a controller nothing that it could disturb them with."""
    requests = os.fdopen(os.dup(0), "rb")
    answers = os.fdopen(os.dup(1), "wb")
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.dup2(2, 1)
    os.close(nothing)
    return requests, answers


if __name__ == "__main__":
    _, most = resource.getrlimit(resource.RLIMIT_DATA)
    limit = MEMORY_LIMIT if most == resource.RLIM_INFINITY else min(MEMORY_LIMIT, most)
    resource.setrlimit(resource.RLIMIT_DATA, (limit, limit))
    serve(int(sys.argv[1]), sys.argv[2])
