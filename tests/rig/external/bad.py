"""A controller that never brakes less, but for the fault that its parameters name."""

import ctypes
import locale
import math
import os
import platform
import signal
import subprocess
import sys
import threading
import time
from contextlib import suppress
from pathlib import Path

import numpy as np

from uictest.controllers import Outputs

__version__ = "1.2"


def leave(fault, call):
    """Change the state of the process in the call that the fault names, as in bad.c."""
    what, _, named = fault.partition(":")
    if named == call:
        LEAVES[what]()


LEAVES = {
    "rounding": lambda: ctypes.CDLL(None).fesetround(UPWARD),
    "locale": lambda: locale.setlocale(locale.LC_ALL, "C"),
    "folder": lambda: os.chdir("/"),
    "signal": lambda: signal.signal(signal.SIGTERM, lambda number, frame: None),
    "alarm": lambda: signal.setitimer(signal.ITIMER_REAL, 3600.0),
    "numpy": lambda: np.seterr(all="raise"),
}
UPWARD = 0x400000 if platform.machine() == "aarch64" else 0x800


class Bad:
    def __init__(self, config):
        self.fault = config.parameters["fault"]
        leave(self.fault, "create")
        self.at = config.parameters["at"]
        if self.fault == "create":
            raise ValueError("told to")
        if self.fault == "leave":
            raise SystemExit(0)

    def __del__(self):
        leave(self.fault, "destroy")
        if self.fault == "immortal":
            time.sleep(3600.0)
        if self.fault == "hang-later":
            # The main thread then waits for the next stop.
            threading.Timer(0.1, hang_and_tell).start()

    def reset(self):
        leave(self.fault, "reset")
        if self.fault == "reset":
            raise ValueError("told to")
        if self.fault == "leave-reset":
            raise SystemExit(0)

    def step(self, inputs):
        filling = [0, 0, 0, 0]
        if inputs.cycle == self.at:
            leave(self.fault, "step")
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
    ctypes.PyDLL(None).sleep(3600)  # no other thread can run beside


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


def say(text):
    sys.stdout.write(text)
    sys.stderr.write(text + "\n")
    return Outputs([0, 0, 0, 0], [0, 0, 0, 0])


def say_and_crash():
    say("last words")
    ctypes.string_at(0)


def close_streams():
    os.close(1)
    os.close(2)
    time.sleep(0.3)
    return Outputs([0, 0, 0, 0], [0, 0, 0, 0])


def close_files():
    os.closerange(3, 1024)
    return Outputs([0, 0, 0, 0], [0, 0, 0, 0])


def flood():
    for _ in range(64):
        os.write(2, b"x" * 65535 + b"\n")
    return Outputs([0, 0, 0, 0], [0, 0, 0, 0])


def fail_on_the_way():
    """Raise at the entry of the next step, before any line of it, as the handler of a signal may."""

    def trace(frame, event, argument):
        if frame.f_code.co_name == "_step":
            raise RuntimeError("told to, early")

    sys.settrace(trace)
    return Outputs([0, 0, 0, 0], [0, 0, 0, 0])


FAULTS = {
    "way": fail_on_the_way,
    "infinite": lambda: Outputs([0, 0, 0, 0], [0, 0, 0, 0], reference_speed=-math.inf),
    "say": lambda: say("from Python "),
    "say-crash": say_and_crash,
    "flood": flood,
    "files": close_files,
    "close": close_streams,
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
