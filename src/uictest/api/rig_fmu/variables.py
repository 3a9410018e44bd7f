"""The variables of the FMU, each declared once, and where each lies in the memory of an instance."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from typing import Any, Final, Literal

import numpy as np

from uictest.rig import STOP_MEMORY

Kind = Literal["real", "boolean", "integer"]
Causality = Literal["independent", "input", "output", "parameter"]

INSTANCE_MEMORY: Final[Any] = np.dtype(
    [("stop", STOP_MEMORY), ("time", "f8"), ("ended", "i8"), ("hold", "i4", 4), ("vent", "i4", 4)]
)
"""A stop, the time of the simulation, whether the stop has ended, and the commands as last set."""


@dataclass(frozen=True, slots=True)
class Variable:
    """One variable of the FMU.

    Attributes:
        name: in the model description.
        description: one line.
        kind: of value.
        causality: as FMI has it.
        unit: empty for a pure number.
        offset: of its place in :data:`INSTANCE_MEMORY`, bytes.
        storage: type of the number there: `f8`, `i4` or `i8`.
    """

    name: str
    description: str
    kind: Kind
    causality: Causality
    unit: str
    offset: int
    storage: str


@dataclass(frozen=True, slots=True)
class _Declared:
    name: str
    place: str
    description: str
    unit: str = ""
    kind: Kind = "real"
    causality: Causality = "output"


_READINGS: Final = (
    _Declared("wheel_speed", "stop.exchange.wheel_speed", "Circumferential, as its sensor shows it", "m/s"),
    _Declared(
        "speed_valid",
        "stop.exchange.speed_valid",
        "False where the speed sensor reports a fault",
        kind="boolean",
    ),
    _Declared(
        "cylinder_pressure",
        "stop.exchange.cylinder_pressure",
        "Brake cylinder pressure above atmospheric, as its sensor shows it",
        "Pa",
    ),
)
_COMMANDS: Final = (
    _Declared("hold", "hold", "Holding magnet energised", kind="boolean", causality="input"),
    _Declared(
        "vent",
        "vent",
        "Venting magnet energised; forbidden without the holding magnet",
        kind="boolean",
        causality="input",
    ),
)
_STATES: Final = (
    _Declared("true_wheel_speed", "stop.modules.wheel_speed", "True circumferential speed", "m/s"),
    _Declared("slide", "stop.modules.slide", "1 - true wheel speed / train speed; 0 below 1 m/s"),
    _Declared("friction", "stop.modules.friction", "Friction coefficient of the rail under the wheelset"),
    _Declared("adhesion", "stop.modules.adhesion", "Adhesion in use"),
    _Declared("wheel_load", "stop.modules.wheel_load", "Load of one wheel", "N"),
    _Declared("tank_pressure", "stop.modules.tank_pressure", "True pressure above atmospheric", "Pa"),
    _Declared("clamping_force", "stop.modules.clamping_force", "Clamping force of one caliper", "N"),
    _Declared("brake_torque", "stop.modules.brake_torque", "Brake torque of the wheelset", "N.m"),
)
_TRAIN: Final = (
    _Declared("train_speed", "stop.train.speed", "True speed of the train", "m/s"),
    _Declared("distance", "stop.train.distance", "Distance since the brake command", "m"),
    _Declared("brake_line_pressure", "stop.train.brake_line_pressure", "Above atmospheric", "Pa"),
    _Declared("reservoir_pressure", "stop.train.reservoir_pressure", "Above atmospheric", "Pa"),
    _Declared("stopped", "stop.car.stopped", "The train stands", kind="boolean"),
    _Declared(
        "ended", "ended", "The train stands or the longest duration has passed; outputs stay", kind="boolean"
    ),
    _Declared("braking_distance", "stop.car.stop_position", "0 until the train stands", "m"),
    _Declared("braking_time", "stop.car.stop_time", "0 until the train stands", "s"),
)


@cache
def variables() -> tuple[Variable, ...]:
    """Return the variables in the order of their value references, from 0."""
    return tuple(_located())


def _located() -> Iterator[Variable]:
    yield _variable(_Declared("time", "time", "Time of the simulation", "s", causality="independent"))
    yield from (each for declared in _COMMANDS for each in _of_wheelsets(declared))
    yield from (each for declared in _READINGS for each in _of_wheelsets(declared))
    demand = "Share of full service; a brake is demanded above 0"
    yield _variable(_Declared("brake_demand", "stop.exchange.brake_demand", demand))
    yield from map(_variable, _TRAIN)
    yield from (each for declared in _STATES for each in _of_wheelsets(declared))
    seed = "Seed of the sensor noise"
    yield _variable(_Declared("seed", "stop.parameters.seed", seed, kind="integer", causality="parameter"))


def _of_wheelsets(declared: _Declared) -> Iterator[Variable]:
    for number in range(1, 5):
        description = f"{declared.description}, wheelset {number}"
        yield _variable(declared, f"{declared.name}_{number}", description, number - 1)


def _variable(declared: _Declared, name: str = "", description: str = "", place: int = 0) -> Variable:
    offset, storage = _place(declared.place, place)
    return Variable(
        name or declared.name,
        description or declared.description,
        declared.kind,
        declared.causality,
        declared.unit,
        offset,
        storage,
    )


def place_of(path: str) -> int:
    """Return the offset of a field of :data:`INSTANCE_MEMORY` that a dotted path names."""
    return _place(path, 0)[0]


def _place(path: str, place: int) -> tuple[int, str]:
    """Return offset and storage of a field; of several, in an array of numbers or of records, one."""
    layout, offset = INSTANCE_MEMORY, 0
    for name in path.split("."):
        if layout.subdtype is not None:  # an array of records: as many records as there are wheelsets, or one
            record, shape = layout.subdtype
            offset += (place if shape[-1] > 1 else 0) * record.itemsize
            layout = record
        layout, offset = layout.fields[name][0], offset + layout.fields[name][1]
    if layout.subdtype is not None:
        layout = layout.subdtype[0]
        offset += place * layout.itemsize
    return offset, layout.str[1:]
