"""A controller that never brakes less, but for the fault that its parameters name."""

import ctypes
import math
import os
import time
from contextlib import suppress
from typing import Any

from uictest.controllers import Config, Inputs, Outputs

__version__ = "1.2"


class Bad:
    def __init__(self, config: Config) -> None:
        self.fault: str = config.parameters["fault"]
        self.at: int = config.parameters["at"]
        if self.fault == "create":
            raise ValueError("told to")
        if self.fault == "leave":
            raise SystemExit(0)

    def reset(self) -> None:
        if self.fault == "reset":
            raise ValueError("told to")
        if self.fault == "leave-reset":
            raise SystemExit(0)

    def step(self, inputs: Inputs) -> Any:
        filling: list[float] = [0, 0, 0, 0]
        return (
            FAULTS[self.fault]()
            if inputs.cycle == self.at and self.fault in FAULTS
            else Outputs(filling, filling)
        )


def spin() -> None:
    while True:
        pass


def fail() -> None:
    raise ValueError("told to")


def end() -> None:
    raise SystemExit(0)


class MuteError(Exception):
    def __str__(self) -> str:
        raise RuntimeError("told to")


def fail_mute() -> None:
    raise MuteError


def fail_at_length() -> None:
    raise ValueError("x" * 1_000_000)


def scribble() -> Outputs:
    for descriptor in range(3, 30):
        with suppress(OSError):
            os.write(descriptor, b"\x01\x00\x00\x00" + b"\x7f\x00\x00\x00\x00\x00\x00\x00")
    return Outputs([0, 0, 0, 0], [0, 0, 0, 0])


FAULTS = {
    "scribble": scribble,
    "mute": fail_mute,
    "long": fail_at_length,
    "crash": lambda: ctypes.string_at(0),
    "hang": lambda: time.sleep(3600.0),
    "spin": spin,
    "exit": lambda: os._exit(3),
    "raise": fail,
    "end": end,
    "nothing": lambda: None,
    "nan": lambda: Outputs([math.nan, 0, 0, 0], [0, 0, 0, 0]),
    "short": lambda: Outputs([0, 0, 0], [0, 0, 0, 0]),
    "forbidden": lambda: Outputs([0, 0, 0, 0], [0, 1, 0, 0]),
    "speed": lambda: Outputs([0, 0, 0, 0], [0, 0, 0, 0], reference_speed="fast"),  # type: ignore[arg-type]
    "bits": lambda: Outputs([0, 0, 0, 0], [0, 0, 0, 0], diagnosis=2**32),
}

PARAMETERS = {"fault": {"default": "none"}, "at": {"default": 700, "unit": "1"}}
