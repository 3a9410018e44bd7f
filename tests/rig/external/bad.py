"""A controller that never brakes less, but for the fault that its parameters name."""

import ctypes
import math
import os
import signal
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

from uictest.controllers import Outputs

__version__ = "1.2"


class Bad:
    def __init__(self, config):
        self.fault = config.parameters["fault"]
        self.at = config.parameters["at"]
        if self.fault == "create":
            raise ValueError("told to")
        if self.fault == "leave":
            raise SystemExit(0)

    def __del__(self):
        if self.fault == "immortal":
            time.sleep(3600.0)
        if self.fault == "hang-later":
            # The main thread then waits for the next stop.
            signal.signal(signal.SIGALRM, lambda number, frame: hang_and_tell())
            signal.setitimer(signal.ITIMER_REAL, 0.1)

    def reset(self):
        if self.fault == "reset":
            raise ValueError("told to")
        if self.fault == "leave-reset":
            raise SystemExit(0)

    def step(self, inputs):
        filling = [0, 0, 0, 0]
        return (
            FAULTS[self.fault]()
            if inputs.cycle == self.at and self.fault in FAULTS
            else Outputs(filling, filling)
        )


def spin():
    while True:
        pass


def hang_and_tell():
    Path("hangs.txt").touch()
    time.sleep(3600.0)


def hold_the_interpreter():
    """Start a process of its own, then hang in a call that no other thread can run beside."""
    sleeper = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(3600)"])
    Path("started.txt").write_text(str(sleeper.pid), "utf-8")
    ctypes.PyDLL(None).sleep(3600)


def fail():
    raise ValueError("told to")


def end():
    raise SystemExit(0)


class MuteError(Exception):
    def __str__(self):
        raise RuntimeError("told to")


def fail_mute():
    raise MuteError


def fail_at_length():
    raise ValueError("x" * 1_000_000)


def scribble():
    for descriptor in range(3, 30):
        with suppress(OSError):
            os.write(descriptor, b"\x01\x00\x00\x00" + b"\x7f\x00\x00\x00\x00\x00\x00\x00")
    return Outputs([0, 0, 0, 0], [0, 0, 0, 0])


def forge(head):
    for descriptor in range(3, 30):
        with suppress(OSError):
            os.write(descriptor, b"\x01\x00\x00\x00" + len(head).to_bytes(8, "little") + head)
    return Outputs([0, 0, 0, 0], [0, 0, 0, 0])


FAULTS = {
    "scribble": scribble,
    "forge-object": lambda: forge(b"{}"),
    "forge-list": lambda: forge(b"[]"),
    "forge-depth": lambda: forge(b"[" * 100_000),
    "mute": fail_mute,
    "long": fail_at_length,
    "crash": lambda: ctypes.string_at(0),
    "hang": lambda: time.sleep(3600.0),
    "spin": spin,
    "hold": hold_the_interpreter,
    "memory": lambda: bytearray(1 << 40),
    "exit": lambda: os._exit(3),
    "raise": fail,
    "end": end,
    "nothing": lambda: None,
    "nan": lambda: Outputs([math.nan, 0, 0, 0], [0, 0, 0, 0]),
    "short": lambda: Outputs([0, 0, 0], [0, 0, 0, 0]),
    "forbidden": lambda: Outputs([0, 0, 0, 0], [0, 1, 0, 0]),
    "speed": lambda: Outputs([0, 0, 0, 0], [0, 0, 0, 0], reference_speed="fast"),
    "bits": lambda: Outputs([0, 0, 0, 0], [0, 0, 0, 0], diagnosis=2**32),
}

PARAMETERS = {"fault": {"default": "none"}, "at": {"default": 700, "unit": "1"}}
