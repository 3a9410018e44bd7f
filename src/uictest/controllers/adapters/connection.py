"""A connection to a program that listens on a TCP port: one frame out, one frame back."""

import socket
from contextlib import suppress
from time import monotonic
from typing import Final

from uictest.controllers.adapters.instance import ControllerError
from uictest.controllers.adapters.socket_frames import (
    DONE,
    FAILED,
    HEADER,
    HELLO,
    LONGEST_REASON,
    RESET,
    STEP,
    text_of,
)

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
                place = f"after {received} of {needed} bytes of" if received else "before"
                raise ControllerError(
                    f"the program closed the connection {place} its answer to the {_NAMES[kind]}"
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
            limit = f"{self._time_limit:g} s"
            raise ControllerError(f"{amount} to the {_NAMES[kind]} within {limit}") from None
        except OSError as error:
            raise ControllerError(f"the connection broke: {error.strerror or error}") from None

    def _checked_length(self, kind: bytes, size: int) -> int:
        """Return the bytes of the answer's body. Raises ControllerError where its header is another one."""
        found, length, number = HEADER.unpack_from(self._memory)
        if found == FAILED and length <= LONGEST_REASON:
            return int(length)
        answer = f"the answer to the {_NAMES[kind]}"
        if found != kind:
            raise ControllerError(f"{answer} begins with {found!r}, expected {kind!r}")
        if number != self._number:
            raise ControllerError(f"{answer} has the number {number}, expected {self._number}")
        if length != size:
            raise ControllerError(f"{answer} has {length} bytes, expected {size}")
        return size
