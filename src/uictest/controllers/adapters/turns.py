"""Turns at an address: the program that listens there serves one stop at a time."""

import socket
from contextlib import suppress
from threading import Lock
from time import monotonic, sleep
from typing import Final

from uictest.controllers.adapters.errors import ControllerError

STARTING: Final = 5.0
"""Longest time in which a program starts to listen, s; chosen: an interpreter takes about one."""
_PAUSE: Final = 0.05
"""Time between two attempts to connect, s; chosen."""


class _Address:
    """What all stops at an address share."""

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
                return self._attempt()
            except OSError as error:
                if monotonic() >= until:
                    self._address.patience = 0.0
                    reason = error.strerror or str(error)
                    message = f"no program listens at {self._location} ({reason}); start it before the run"
                    raise ControllerError(message) from None
            sleep(_PAUSE)

    def _attempt(self) -> socket.socket:
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
