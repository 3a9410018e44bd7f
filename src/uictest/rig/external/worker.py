"""A child process that runs stops with controllers from outside, watched from here."""

import mmap
import os
import signal
import subprocess
import tempfile
import weakref
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from select import select
from socket import socket, socketpair
from time import monotonic
from typing import Any, Final, TypeVar

import numpy as np

from uictest.controllers import (
    CLOSING,
    EXCHANGE,
    EXPLAINING,
    NOT_CALLED,
    OPENING,
    STEPPING,
    WROTE_BEYOND,
    ControllerError,
    ProgramKey,
)
from uictest.core.guarded_process import GuardedProcess
from uictest.rig.external.drives import DriveRequest, Drives
from uictest.rig.external.in_process import BlockInputs, BlockRun
from uictest.rig.external.messages import (
    BrokenMessageError,
    Message,
    StreamEndedError,
    block_message,
    drive_message,
    drives_of,
    read_message,
    run_of,
    train_message,
    train_stop_of,
    write_message,
)
from uictest.rig.external.process_state import require_guard
from uictest.rig.kernel.library import source_digest
from uictest.rig.train_stop import TrainInputs, TrainStop

LARGEST_BLOCK: Final = 256
"""Most stops that a child runs at once."""
OPENING_LIMIT: Final = 60.0
"""Longest time to load, create and reset a controller, s; chosen: Python files may import large packages."""
ANSWER_LIMIT: Final = 60.0
"""Longest time without a byte taken of a request, or sent of an answer, s; chosen: most take
milliseconds."""
IDLE_LIMIT: Final = 300.0
"""Longest time in which a child neither calls a controller nor answers, s; chosen: it starts in a second, and
between two cycles the rig takes microseconds."""
_LONGEST_WAIT: Final = 0.1
"""Time between two looks at a child that has not answered, s; chosen."""
_CHILD: Final = "uictest.rig.external.child"
_NAMES: Final = {
    STEPPING: "step",
    OPENING: "loading, create or reset",
    CLOSING: "destroy",
    EXPLAINING: "last_error",
    NOT_CALLED: "what runs outside of its calls (a destructor, a thread)",
}

LARGEST_OUTPUT: Final = 2**20
"""Bytes that are kept of what a controller prints in a stop; chosen: some ten thousand lines."""
_PIPE: Final = 2**16
"""Bytes that a pipe holds at most."""


class PrintedOutput:
    """The pipe of a child, which is given `its_end`; None where it prints to our standard error."""

    def __init__(self, *, kept: bool) -> None:
        self.its_end: int | None = None
        self.open_ends: list[int] = []
        """Our end, until the child has closed its own."""
        if kept:
            end, self.its_end = os.pipe()
            os.set_blocking(end, False)
            self.open_ends.append(end)
        self._kept, self._size = bytearray(), 0

    def read(self) -> None:
        """Take what is there: more than a pipe holds has no place to wait."""
        for end in self.open_ends:
            with suppress(BlockingIOError):
                part = os.read(end, _PIPE)
                self._size += len(part)
                self._kept += part[: LARGEST_OUTPUT - len(self._kept)]
                if not part:
                    self.close()

    def taken(self) -> str:
        """Return the text printed since the last call, with a note on the bytes of it that were dropped."""
        self.read()
        text, lost = self._kept.decode("utf-8", "replace"), self._size - len(self._kept)
        self._kept, self._size = bytearray(), 0
        return f"{text}\n... {lost} bytes more, {LARGEST_OUTPUT} are kept\n" if lost else text

    def close(self) -> None:
        """Close our end."""
        while self.open_ends:
            os.close(self.open_ends.pop())


Read = TypeVar("Read")


class LostChildError(ControllerError):
    """A controller crashed, or did not return in time, and its process is gone.

    `index` is that of the stop in its block, None where it is not known.
    """

    def __init__(self, message: str, index: int | None) -> None:
        super().__init__(message)
        self.index = index


class Worker:
    """A child process; one thread at a time uses it, for one program, or those of a train in one folder.

    A process holds one module or library of a name: what lies beside another file of the same program in
    another version would take the place of its own.
    """

    def __init__(self, keys: frozenset[ProgramKey], *, keep_output: bool = False) -> None:
        """Start it; what it prints is kept, or goes to standard error. Raises ControllerError."""
        require_guard()
        self.keys = keys
        """Of the programs that may run on it."""
        self.printed = printed = PrintedOutput(kept=keep_output)
        # The child is ended by a signal and removes no file: its temporary files lie in a folder of ours.
        self._folder = tempfile.TemporaryDirectory(prefix="uictest-child-", ignore_cleanup_errors=True)
        with tempfile.TemporaryFile() as shared:
            shared.truncate(LARGEST_BLOCK * EXCHANGE.itemsize)
            self._memory = mmap.mmap(shared.fileno(), 0)
            self._exchanges: Any = np.frombuffer(self._memory, EXCHANGE)
            self._process, self._channel = _start_process(shared.fileno(), self._folder.name, printed)
        self._release = weakref.finalize(self, _end, self._process, self._channel, self._folder, printed)
        self.usable = True
        """Whether another stop may be run on it."""

    def run_train(self, inputs: TrainInputs, steps_per_sample: int) -> TrainStop:
        """Run a stop of a train.

        Raises ControllerError; LostChildError where the child is gone, whose `index` counts such cars only.
        """
        programs = list(inputs.from_outside.values())
        request = train_message(inputs, steps_per_sample)
        return self._answer(request, programs, lambda answer: train_stop_of(answer, inputs.parameters))

    def run_block(self, inputs: BlockInputs) -> BlockRun:
        """Run at most :data:`LARGEST_BLOCK` stops. Raises LostChildError."""
        return self._answer(block_message(inputs), inputs.programs, run_of)

    def drive(self, request: DriveRequest) -> Drives:
        """Drive a controller through given cycles. Raises ControllerError, as :meth:`run_train`."""
        return self._answer(drive_message(request), [request.program], drives_of)

    def close(self) -> None:
        """End the child and whatever it has started."""
        self.usable = False
        self.printed.read()
        self._release()

    def _answer(self, request: Message, programs: Any, read: Callable[[Message], Read]) -> Read:
        """Return the content of the answer. Raises ControllerError; a damaged child is not used again."""
        # Only those in use: a library may write over any.
        self._exchanges = np.frombuffer(self._memory, EXCHANGE, len(programs))
        try:
            answer = self._answer_to(request, [program.time_limit for program in programs])
            error = answer.head.get("error", "")
            try:
                result = None if error else read(answer)
            except Exception:  # its true answer would be taken for that of the next stop
                raise self._lost_child_error("its process sent something else than an answer") from None
        except BaseException:
            self.close()
            raise
        # A controller that wrote where it should not may have damaged anything in the child.
        self.usable = not (self._exchanges["failure"] == WROTE_BEYOND).any()
        if result is None:
            raise ControllerError(str(error))
        return result

    def _answer_to(self, request: Message, time_limits: Sequence[float]) -> Message:
        try:
            self._request(request)
            self._wait(time_limits)
            with self._channel.makefile("rb") as answers:
                return read_message(answers)
        except (BrokenMessageError, TimeoutError):
            raise self._lost_child_error("its process sent something else than an answer") from None
        except (StreamEndedError, BrokenPipeError, ConnectionResetError):
            raise self._lost_child_error(self._ending_in_words()) from None

    def _request(self, request: Message) -> None:
        with self._channel.makefile("wb") as requests:
            try:
                write_message(requests, request)
            except TimeoutError:
                raise self._lost_child_error(
                    f"its process took no request within {ANSWER_LIMIT:g} s"
                ) from None

    def _wait(self, time_limits: Sequence[float]) -> None:
        """Wait for an answer; a child that does not get on in time, whatever it does, is an error."""
        state, since = self._state(), monotonic()
        while True:
            watched: list[socket | int] = [self._channel, *self.printed.open_ends]
            ready, _, _ = select(watched, [], [], min(_LONGEST_WAIT, *time_limits))
            self.printed.read()
            if self._channel in ready:
                return
            now = self._state()
            if now != state:
                state, since = now, monotonic()
            stop, calling, _ = state
            least = {STEPPING: 0.0, NOT_CALLED: IDLE_LIMIT}.get(calling, OPENING_LIMIT)
            limit = max(least, time_limits[stop])
            if monotonic() - since > limit:
                raise self._lost_child_error(f"{_NAMES[calling]} did not return within {limit:g} s")

    def _state(self) -> tuple[int, int, int]:
        """Return the stop whose controller is being called, the kind of call, and the steps begun so far."""
        calling = self._calling()
        stop = int(calling.argmax())
        return stop, int(calling[stop]), int(self._exchanges["cycles"].sum())

    def _calling(self) -> Any:
        """Return the present call of each controller; a number that a library wrote over it is not a call."""
        calling = self._exchanges["calling"]
        return np.where(np.isin(calling, list(_NAMES)), calling, NOT_CALLED)

    def _lost_child_error(self, what: str) -> LostChildError:
        """Return the error of the stop whose controller has not returned."""
        calling = np.flatnonzero(self._calling())
        stop = int(calling[0]) if calling.size else None
        exchange = self._exchanges[stop or 0]
        cycle = f"cycle {exchange['cycle']}" if exchange["cycles"] else "before the first cycle"
        return LostChildError(f"{what} ({cycle})", stop)

    def _ending_in_words(self) -> str:
        """Return in words how the child ended."""
        _, calling, _ = self._state()
        try:
            code = self._process.wait(ANSWER_LIMIT)
        except subprocess.TimeoutExpired:
            code = os.EX_IOERR
        if code == os.EX_IOERR:
            return "closed files of its process that are not its own: what its answers go through is one"
        crash = f"crashed with {signal.Signals(-code).name}" if code < 0 else ""
        within = "" if calling in (STEPPING, NOT_CALLED) else f"{_NAMES[calling]} "
        return within + (crash or f"ended its process with exit code {code}")


def _start_process(exchange_file: int, folder: str, printed: PrintedOutput) -> tuple[GuardedProcess, socket]:
    channel, its_channel = socketpair()
    channel.settimeout(ANSWER_LIMIT)
    streams = {"stdin": its_channel, "stdout": its_channel, "stderr": printed.its_end}
    try:
        # -P: modules of the working folder are not ours, whatever they are called. -u: what Python and C
        # print belongs to the stop in which they do, and is not lost in a crash.
        process = GuardedProcess(
            _CHILD,
            [str(exchange_file), source_digest()],
            Path(folder),
            ["-P", "-u"],
            pass_fds=(exchange_file,),
            **streams,
        )
    except BaseException:
        channel.close()
        raise
    finally:
        its_channel.close()
        if printed.its_end is not None:
            os.close(printed.its_end)
    return process, channel


def _end(process: GuardedProcess, channel: socket, folder: Any, printed: PrintedOutput) -> None:
    process.end()
    channel.close()
    folder.cleanup()
    printed.close()
