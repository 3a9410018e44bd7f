"""Controllers in a program of their own, which listens on a TCP port.

Every frame is a header and a body. The header holds the kind of the frame (four letters), the number of bytes
of its body (32 bits) and the number of the frame (64 bits): uictest numbers what it sends on a connection
from 0. The program answers every frame but the last with one of the same kind and number, or with FAIL and a
reason.

    kind   body from uictest                                    body of the answer
    HELO   GREETING, then the parameters as JSON in UTF-8       PROGRAM
    RSET   none                                                 none
    STEP   `uictest_inputs`                                     `uictest_outputs`
    DONE   none                                                 no answer: both sides close the connection
    FAIL   -                                                    reason in UTF-8, at most 1000 bytes

Header, order of the frames and the first field of HELO stay as they are in every version of the protocol.
uictest greets with version 1. Where the program answers with version 2, STEP has the inputs and outputs of
version 2 of the contract. A program serves one stop at a time: stops take turns at its address.
"""

import ctypes
import socket
import struct
from collections.abc import Callable
from contextlib import suppress
from threading import Lock
from time import monotonic, sleep
from typing import Final

from uictest.controllers.adapters.instance import (
    CallbackInstance,
    ControllerError,
    ResponseTimes,
    checked_contract,
)
from uictest.controllers.declared import ControllerProgram
from uictest.controllers.interface import INPUT_BYTES, OUTPUT_BYTES, WHEELSETS, Config

PROTOCOL_VERSION: Final = 1
"""That a greeting states."""

HEADER: Final = struct.Struct("<4sIQ")
"""Kind, bytes of the body, number of the frame."""
GREETING: Final = struct.Struct(f"<4I2d{WHEELSETS}d32s")
"""Protocol version, bytes of `uictest_inputs`, of `uictest_outputs`, wheelsets, cycle time (s), initial speed
(m/s), wheel radii (m), SHA-256 of the case."""
PROGRAM: Final = struct.Struct("<I60s")
"""Protocol version, name and version of the program in UTF-8, filled up with zeros."""

HELLO: Final = b"HELO"
RESET: Final = b"RSET"
STEP: Final = b"STEP"
DONE: Final = b"DONE"
FAILED: Final = b"FAIL"
LONGEST_REASON: Final = 1000
LONGEST_PARAMETERS: Final = (1 << 16) - GREETING.size
"""Bytes; chosen, so that a program may receive every frame in memory of 64 KiB."""


def greeting(config: Config, parameters: str) -> bytes:
    """Return the body of the first frame. Raises ControllerError where the parameters are too long."""
    text = parameters.encode()
    if len(text) > LONGEST_PARAMETERS:
        raise ControllerError(
            f"parameters: {len(text)} bytes as JSON, at most {LONGEST_PARAMETERS} can be sent"
        )
    sizes = INPUT_BYTES[PROTOCOL_VERSION], OUTPUT_BYTES[PROTOCOL_VERSION], config.wheelsets
    speeds = config.cycle_time, config.initial_speed, *config.wheel_radius
    return GREETING.pack(PROTOCOL_VERSION, *sizes, *speeds, bytes.fromhex(config.case_sha256)) + text


def text_of(content: bytes) -> str:
    """Return the text before the first zero."""
    return content.partition(b"\0")[0].decode("utf-8", "replace").strip()


_NAMES: Final = {HELLO: "greeting", RESET: "reset frame", STEP: "step frame"}


class Connection:
    """Sends frames and receives their answers, each answer within a limit of time.

    Whatever the program does instead raises ControllerError with what was received.
    """

    def __init__(self, stream: socket.socket, time_limit: float) -> None:
        stream.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._stream = stream
        self._time_limit = time_limit
        self._number = 0
        self._memory = memoryview(bytearray(HEADER.size + LONGEST_REASON))

    def request(self, kind: bytes, body: bytes, size: int) -> bytes:
        """Send a frame and return the body of its answer, so many bytes. Raises ControllerError."""
        deadline = monotonic() + self._time_limit
        self._send(kind, body)
        received = self._receive(0, HEADER.size, kind, deadline)
        end = HEADER.size + self._checked_length(kind, size)
        received = self._receive(received, end, kind, deadline)
        answer = bytes(self._memory[HEADER.size : end])
        if bytes(self._memory[:4]) == FAILED:
            raise ControllerError(text_of(answer) or "no reason given")
        if received > end:
            raise ControllerError(f"{received - end} bytes follow the answer to the {_NAMES[kind]}")
        self._number += 1
        return answer

    def finish(self) -> None:
        """Say that the stop is over; the connection may be broken already."""
        with suppress(OSError):
            self._stream.sendall(HEADER.pack(DONE, 0, self._number))

    def _send(self, kind: bytes, body: bytes) -> None:
        try:
            self._stream.settimeout(self._time_limit)
            self._stream.sendall(HEADER.pack(kind, len(body), self._number) + body)
        except TimeoutError:
            limit = f"{self._time_limit:g} s"
            raise ControllerError(f"the program did not receive the {_NAMES[kind]} within {limit}") from None
        except OSError as error:
            raise ControllerError(f"the connection broke: {error.strerror or error}") from None

    def _receive(self, received: int, needed: int, kind: bytes, deadline: float) -> int:
        """Receive until so many bytes of the answer are there; return how many there are."""
        while received < needed:
            part = self._receive_part(received, needed, kind, deadline)
            if part == 0:
                when = f"after {received} of {needed} bytes of" if received else "before"
                raise ControllerError(
                    f"the program closed the connection {when} its answer to the {_NAMES[kind]}"
                )
            received += part
        return received

    def _receive_part(self, received: int, needed: int, kind: bytes, deadline: float) -> int:
        try:
            if (remaining := deadline - monotonic()) <= 0.0:
                raise TimeoutError
            self._stream.settimeout(remaining)
            return self._stream.recv_into(self._memory[received:])
        except TimeoutError:
            amount = f"only {received} of {needed} bytes of the answer" if received else "no answer"
            # One address under two names is one program: its second stop waits for the end of the first.
            hint = "; does the program serve another stop?" if kind == HELLO and not received else ""
            limit = f"{self._time_limit:g} s"
            raise ControllerError(f"{amount} to the {_NAMES[kind]} within {limit}{hint}") from None
        except OSError as error:
            raise ControllerError(f"the connection broke: {error.strerror or error}") from None

    def _checked_length(self, kind: bytes, size: int) -> int:
        """Return the bytes of the answer's body. Raises ControllerError where its header is another one."""
        kind_found, length, number = HEADER.unpack_from(self._memory)
        if kind_found == FAILED and length <= LONGEST_REASON:
            return int(length)
        answer = f"the answer to the {_NAMES[kind]}"
        if kind_found != kind:
            raise ControllerError(f"{answer} begins with {kind_found!r}, expected {kind!r}")
        if number != self._number:
            raise ControllerError(f"{answer} has the number {number}, expected {self._number}")
        if length != size:
            raise ControllerError(f"{answer} has {length} bytes, expected {size}")
        return size


class RealTime:
    """Paces the cycles of one stop.

    Args:
        cycle_time: from one cycle to the next, s.
        clock: the time, s.
        wait: waits for so many s.
    """

    def __init__(
        self, cycle_time: float, clock: Callable[[], float] = monotonic, wait: Callable[[float], None] = sleep
    ) -> None:
        self._cycle_time = cycle_time
        self._clock = clock
        self._wait = wait
        self._first = 0.0
        self._sent = 0.0
        self._cycle = 0
        self._late = False
        self._missed = 0
        self._longest = 0.0
        self._longest_cycle = 0
        self._jitter = 0.0

    def begin_cycle(self) -> None:
        """Wait until the next cycle is due."""
        now = self._clock()
        if self._cycle == 0:
            self._first = now
        due = self._due_time(self._cycle)
        if now < due:
            self._wait(due - now)
            now = self._clock()
        self._sent = now
        if not self._late:
            self._jitter = max(self._jitter, now - due)

    def end_cycle(self) -> None:
        """Note that the answer has come."""
        now = self._clock()
        if now - self._sent > self._longest:
            self._longest, self._longest_cycle = now - self._sent, self._cycle
        self._cycle += 1
        self._late = now > self._due_time(self._cycle)
        self._missed += self._late

    @property
    def response_times(self) -> ResponseTimes:
        """Statistics of the controller's answers so far."""
        return ResponseTimes(
            *(self._cycle, self._cycle_time, self._missed),
            *(self._longest, self._longest_cycle, self._jitter),
        )

    def _due_time(self, cycle: int) -> float:
        return self._first + cycle * self._cycle_time


STARTING: Final = 5.0
"""Longest time in which a program starts to listen, s; chosen: an interpreter takes about one."""
_PAUSE: Final = 0.05
"""Time between two attempts to connect, s; chosen."""


class _Address:
    """State that all stops at an address share."""

    def __init__(self) -> None:
        self.free = Lock()
        self.patience = STARTING
        """Time for which attempts to connect are repeated, s; 0 once no program has listened, so that a batch
        does not wait for every case."""


_ADDRESSES: Final[dict[str, _Address]] = {}
_TURNS: Final[set["Turn"]] = set()
"""Those that wait or are connected."""


def interrupt_turns() -> None:
    """End the stops that wait for a program at a socket; each raises ControllerError in its own thread."""
    turns = tuple(_TURNS)
    for turn in turns:
        turn.interrupted = True
    # Only now: the end of one connection lets the next stop begin, which must not connect any more.
    for turn in turns:
        turn.disconnect()


class Turn:
    """The turn of one stop at an address such as ``tcp://127.0.0.1:5025``."""

    def __init__(self, location: str) -> None:
        self._location = location
        self._address = _ADDRESSES.setdefault(location, _Address())
        self._stream: socket.socket | None = None
        self.interrupted = False

    def begin(self) -> socket.socket:
        """Wait for the stops before this one, then connect. Raises ControllerError where nobody listens."""
        _TURNS.add(self)
        try:
            self._address.free.acquire()
        except BaseException:
            _TURNS.discard(self)
            raise
        try:
            self._stream = self._connected()
            self._reject_interrupted()  # while it was connected
        except BaseException:
            self.end()
            raise
        return self._stream

    def end(self) -> None:
        """Close the connection, and let the next stop begin."""
        _TURNS.discard(self)
        if self._stream is not None:
            self._stream.close()
        self._address.free.release()

    def disconnect(self) -> None:
        """End the stop, if it is connected, from another thread."""
        if self._stream is not None:
            with suppress(OSError):
                self._stream.shutdown(socket.SHUT_RDWR)

    def _connected(self) -> socket.socket:
        until = monotonic() + self._address.patience
        while True:
            try:
                return self._try_to_connect()
            except OSError as error:
                if monotonic() >= until:
                    self._address.patience = 0.0
                    reason = error.strerror or str(error)
                    message = f"no program listens at {self._location} ({reason}); start it before the run"
                    raise ControllerError(message) from None
            sleep(_PAUSE)

    def _try_to_connect(self) -> socket.socket:
        self._reject_interrupted()
        host, _, port = self._location.removeprefix("tcp://").rpartition(":")
        stream = socket.create_connection((host, int(port)), timeout=STARTING)
        if stream.getsockname() == stream.getpeername():
            # Where nobody listens, a port of this machine may be given to both ends of one connection.
            stream.close()
            raise ConnectionRefusedError("connected to itself")
        self._address.patience = STARTING
        return stream

    def _reject_interrupted(self) -> None:
        if self.interrupted:
            raise ControllerError("interrupted before the program was connected")


class SocketInstance(CallbackInstance):
    """The program for one stop: connected and greeted."""

    def __init__(
        self, turn: Turn, connection: Connection, program: ControllerProgram, config: Config
    ) -> None:
        super().__init__()
        self._turn = turn
        self._connection = connection
        self._clock = RealTime(config.cycle_time) if program.real_time else None
        answer = connection.request(HELLO, greeting(config, program.parameters), PROGRAM.size)
        protocol, name = PROGRAM.unpack(answer)
        self.contract = checked_contract(protocol, "the program has protocol version")
        self.version = text_of(name)

    @property
    def response_times(self) -> ResponseTimes | None:
        """Statistics of the program's answers, where cycles are paced by the clock."""
        return None if self._clock is None else self._clock.response_times

    def reset(self) -> None:
        """Let the program reset."""
        self._connection.request(RESET, b"", 0)

    def answer(self, inputs: int, outputs: int) -> None:
        """Let the program answer one cycle, in real time once the cycle is due."""
        if self._clock is not None:
            self._clock.begin_cycle()
        given, size = ctypes.string_at(inputs, INPUT_BYTES[self.contract]), OUTPUT_BYTES[self.contract]
        body = self._connection.request(STEP, given, size)
        if self._clock is not None:
            self._clock.end_cycle()
        ctypes.memmove(outputs, body, size)

    def close(self) -> None:
        """Say that the stop is over, and close the connection."""
        self._connection.finish()
        self._turn.end()


def open_controller(program: ControllerProgram, config: Config) -> SocketInstance:
    """Wait for the turn of this stop, connect, and exchange greetings. Raises ControllerError."""
    turn = Turn(program.location)
    stream = turn.begin()
    try:
        return SocketInstance(turn, Connection(stream, program.time_limit), program, config)
    except BaseException:
        turn.end()
        raise
