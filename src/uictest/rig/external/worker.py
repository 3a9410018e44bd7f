"""A child process that runs stops with controllers from outside, watched from here."""

import mmap
import os
import signal
import subprocess
import sys
import tempfile
import weakref
from collections.abc import Callable, Sequence
from contextlib import suppress
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
from uictest.rig.external.block import BlockInputs, BlockRun
from uictest.rig.external.drives import DriveRequest, Drives
from uictest.rig.external.messages import (
    BrokenMessageError,
    Message,
    StreamEndedError,
    block_message,
    drive_message,
    drives_of,
    finished_of,
    read_message,
    run_of,
    stop_message,
    train_message,
    train_stop_of,
    write_message,
)
from uictest.rig.single_stop import FinishedStop, StopInputs
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
_CHILD: Final = "uictest.rig.external.guard"
_NAMES: Final = {
    STEPPING: "step",
    OPENING: "loading, create or reset",
    CLOSING: "destroy",
    EXPLAINING: "last_error",
    NOT_CALLED: "what runs outside of its calls (a destructor, a thread)",
}

Read = TypeVar("Read")


class LostChildError(ControllerError):
    """A controller crashed, or did not return in time, and its process is gone.

    `place` is that of the stop in its block, None where it is not known.
    """

    def __init__(self, message: str, place: int | None) -> None:
        super().__init__(message)
        self.place = place


class Worker:
    """A child process; one thread at a time uses it, for one program, or those of a train in one folder.

    A process holds one module or library of a name: what lies beside another file of the same program in
    another version would take the place of its own.
    """

    def __init__(self, keys: frozenset[ProgramKey]) -> None:
        self.keys = keys
        """Of the programs that may run on it."""
        # The child is ended by a signal and removes no file: its temporary files lie in a folder of ours.
        self._folder = tempfile.TemporaryDirectory(prefix="uictest-child-", ignore_cleanup_errors=True)
        with tempfile.TemporaryFile() as shared:
            shared.truncate(LARGEST_BLOCK * EXCHANGE.itemsize)
            self._memory = mmap.mmap(shared.fileno(), 0)
            self._exchanges: Any = np.frombuffer(self._memory, EXCHANGE)
            self._process, self._channel, lifeline = _started(shared.fileno(), self._folder.name)
        # Only once: the numbers of a closed pipe and of a collected process may be those of others soon.
        self._release = weakref.finalize(self, _end, self._process, self._channel, lifeline, self._folder)
        self.usable = True
        """Whether another stop may be run on it."""

    def run(self, inputs: StopInputs, steps_per_sample: int) -> FinishedStop:
        """Run a stop. Raises ControllerError; LostChildError where the child is gone."""
        return self._answer(stop_message(inputs, steps_per_sample), [inputs.program], finished_of)

    def run_train(self, inputs: TrainInputs, steps_per_sample: int) -> TrainStop:
        """Run a stop of a train. Raises ControllerError, as :meth:`run`; `place` counts such cars only."""
        programs = list(inputs.from_outside.values())
        request = train_message(inputs, steps_per_sample)
        return self._answer(request, programs, lambda answer: train_stop_of(answer, inputs.parameters))

    def run_block(self, inputs: BlockInputs) -> BlockRun:
        """Run at most :data:`LARGEST_BLOCK` stops. Raises LostChildError."""
        return self._answer(block_message(inputs), inputs.programs, run_of)

    def drive(self, request: DriveRequest) -> Drives:
        """Drive a controller through given cycles. Raises ControllerError, as :meth:`run`."""
        return self._answer(drive_message(request), [request.program], drives_of)

    def close(self) -> None:
        """End the child and whatever it has started."""
        self.usable = False
        self._release()

    def _answer(self, request: Message, programs: Any, read: Callable[[Message], Read]) -> Read:
        """Return what is read in the answer. Raises ControllerError; a damaged child is not used again."""
        # Only those in use: a library may write over any.
        self._exchanges = np.frombuffer(self._memory, EXCHANGE, len(programs))
        try:
            answer = self._asked(request, [program.time_limit for program in programs])
            error = answer.head.get("error", "")
            try:
                result = None if error else read(answer)
            except Exception:  # its true answer would be taken for that of the next stop
                raise self._lost("its process sent something else than an answer") from None
        except BaseException:
            self.close()
            raise
        # A controller that wrote where it should not may have damaged anything in the child.
        self.usable = not (self._exchanges["failure"] == WROTE_BEYOND).any()
        if result is None:
            raise ControllerError(str(error))
        return result

    def _asked(self, request: Message, time_limits: Sequence[float]) -> Message:
        try:
            self._request(request)
            self._wait(time_limits)
            with self._channel.makefile("rb") as answers:
                return read_message(answers)
        except (BrokenMessageError, TimeoutError):
            raise self._lost("its process sent something else than an answer") from None
        except (StreamEndedError, BrokenPipeError, ConnectionResetError):
            raise self._lost(self._ending()) from None

    def _request(self, request: Message) -> None:
        with self._channel.makefile("wb") as requests:
            try:
                write_message(requests, request)
            except TimeoutError:
                raise self._lost(f"its process took no request within {ANSWER_LIMIT:g} s") from None

    def _wait(self, time_limits: Sequence[float]) -> None:
        """Wait for an answer; a child that does not get on in time, whatever it does, is an error."""
        state, since = self._state(), monotonic()
        while not select([self._channel], [], [], min(_LONGEST_WAIT, *time_limits))[0]:
            now = self._state()
            if now != state:
                state, since = now, monotonic()
            place, calling, _ = state
            least = {STEPPING: 0.0, NOT_CALLED: IDLE_LIMIT}.get(calling, OPENING_LIMIT)
            limit = max(least, time_limits[place])
            if monotonic() - since > limit:
                raise self._lost(f"{_NAMES[calling]} did not return within {limit:g} s")

    def _state(self) -> tuple[int, int, int]:
        """Return which stop's controller is asked at present, for what, and how many steps were begun."""
        calling = self._calling()
        place = int(calling.argmax())
        return place, int(calling[place]), int(self._exchanges["cycles"].sum())

    def _calling(self) -> Any:
        """Return what each controller is asked at present; what a library wrote over it is no call."""
        calling = self._exchanges["calling"]
        return np.where(np.isin(calling, list(_NAMES)), calling, NOT_CALLED)

    def _lost(self, what: str) -> LostChildError:
        """Return the error of the stop whose controller has not returned."""
        calling = np.flatnonzero(self._calling())
        place = int(calling[0]) if calling.size else None
        exchange = self._exchanges[place or 0]
        cycle = f"cycle {exchange['cycle']}" if exchange["cycles"] else "before the first cycle"
        return LostChildError(f"{what} ({cycle})", place)

    def _ending(self) -> str:
        """Return in words how the child ended."""
        _, calling, _ = self._state()
        try:
            code = self._process.wait(ANSWER_LIMIT)
        except subprocess.TimeoutExpired:
            return "closed what its answers go through"
        crash = f"crashed with {signal.Signals(-code).name}" if code < 0 else ""
        within = "" if calling in (STEPPING, NOT_CALLED) else f"{_NAMES[calling]} "
        return within + (crash or f"ended its process with exit code {code}")


def _started(exchange_file: int, temporary_folder: str) -> tuple[Any, socket, int]:
    """Start a child; return it, what it is talked to through, and the pipe that keeps it alive."""
    end, lifeline = os.pipe()
    channel, its_channel = socketpair()
    channel.settimeout(ANSWER_LIMIT)
    try:
        process = subprocess.Popen(
            # -P: modules of the working folder are not ours, whatever they are called.
            [sys.executable, "-P", "-m", _CHILD, str(exchange_file), str(end), temporary_folder],
            stdin=its_channel.fileno(),
            stdout=its_channel.fileno(),
            pass_fds=(exchange_file, end),
            # Signals of the terminal are for this process, which ends the child and what that has started.
            start_new_session=True,
            env={**os.environ, "TMPDIR": temporary_folder},
        )
    except BaseException:
        os.close(lifeline)
        channel.close()
        raise
    finally:
        os.close(end)
        its_channel.close()
    return process, channel, lifeline


def _end(process: Any, channel: socket, lifeline: int, folder: tempfile.TemporaryDirectory[str]) -> None:
    """End a child, its guard and whatever it has started."""
    with suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    channel.close()
    os.close(lifeline)
    folder.cleanup()
