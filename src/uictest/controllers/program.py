"""A controller from outside as a scenario names it: what is loaded, and with which settings."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final, Literal

HEADER: Final = Path(__file__).with_name("uictest_controller.h")
"""What a controller in C includes."""

Kind = Literal["python", "library", "fmu", "connect", "registered"]


@dataclass(frozen=True, slots=True)
class ControllerProgram:
    """A controller that is no part of this package.

    Attributes:
        kind: the key that names it in a scenario.
        location: absolute path of its file, address of its socket, or its registered name.
        sha256: of the file; empty where there is none.
        parameters: its parameters as a JSON object.
        options: what only this kind has, such as ``class``.
        time_limit: longest time for one answer, s.
        real_time: whether its cycles are paced by the clock; only a program at a socket can be.
    """

    kind: Kind
    location: str
    sha256: str = ""
    parameters: str = "{}"
    options: Mapping[str, Any] = field(default_factory=dict)
    time_limit: float = 5.0
    real_time: bool = False
