"""Programs at a socket, on threads of the tests: they keep to the protocol or depart from it at one frame."""

import socket
import struct
import threading
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import pytest

from uictest.controllers import Config, ControllerProgram

HEADER = struct.Struct("<4sIQ")
OUTPUTS = struct.Struct("<d8i2I")
ANSWERS = {
    b"HELO": struct.pack("<I60s", 1, "Bremsprüfer 2.1".encode()),
    b"RSET": b"",
    b"STEP": OUTPUTS.pack(31.5, 1, 1, 0, 0, 0, 1, 0, 0, 0xFFFFFFFF, 0),
}


class Program:
    """Listens on a port of its own until the test ends.

    The answer with the number `at`, or each where that is None, goes through `fault`: what that returns is
    sent instead; after None the connection is closed.
    """

    def __init__(self, fault=None, at=0):
        self.received = []
        self.streams = []
        self._fault, self._at = fault, at
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.address = f"tcp://127.0.0.1:{self._listener.getsockname()[1]}"
        self._threads = [threading.Thread(target=self._accept)]
        self._threads[0].start()

    def frames(self):
        """Return what was received on connections that the other side has ended."""
        for thread in self._threads[1:]:
            thread.join()
        return self.received

    def close(self):
        """End what is still connected."""
        self._listener.shutdown(socket.SHUT_RDWR)
        for thread in self._threads:
            thread.join()
        self._listener.close()

    def _accept(self):
        with suppress(OSError):
            while True:
                stream, _ = self._listener.accept()
                self.streams.append(stream)
                self._threads.append(threading.Thread(target=self._serve, args=(stream,)))
                self._threads[-1].start()

    def _serve(self, stream):
        with suppress(OSError), stream, stream.makefile("rb") as frames:  # uictest may have closed it
            while answer := self._answer(frames.read(HEADER.size), frames.read):
                stream.sendall(answer)

    def _answer(self, header, read):
        if len(header) < HEADER.size:
            return None
        kind, size, number = HEADER.unpack(header)
        self.received.append((kind, number, read(size)))
        if kind not in ANSWERS:
            return None
        answer = HEADER.pack(kind, len(ANSWERS[kind]), number) + ANSWERS[kind]
        return self._fault(answer) if self._fault is not None and self._at in (None, number) else answer


Start = Callable[..., Program]


@pytest.fixture
def start():
    """Start programs; they have ended, with all threads and sockets, at the end of the test."""
    # What other tests have left may end meanwhile.
    threads, files = set(threading.enumerate()), open_files()
    programs = []

    def started(fault=None, at=0):
        programs.append(Program(fault, at))
        return programs[-1]

    yield started
    for program in programs:
        program.close()
    assert set(threading.enumerate()) <= threads
    assert open_files() <= files


def open_files():
    """What this process has open; the listing's own descriptor is closed by the time it is looked at."""
    descriptors = Path("/proc/self/fd")
    links = descriptors.iterdir() if descriptors.is_dir() else ()
    return {str(link.readlink()) for link in links if link.is_symlink()}


@pytest.fixture
def config():
    """What a controller is given; every number is another one."""
    return Config(4, 0.01, 33.25, (0.41, 0.42, 0.43, 0.44), {"lower": 0.08}, "0123456789abcdef" * 4)


@pytest.fixture
def at():
    """Name the program at an address in a scenario."""

    def named(address, time_limit=60.0):
        return ControllerProgram("connect", address, parameters='{"lower": 0.08}', time_limit=time_limit)

    return named
