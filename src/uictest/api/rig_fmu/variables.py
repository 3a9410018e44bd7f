"""The variables of the FMU, each declared once, and `case.h`: the case and their places as C has them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, Final, Literal

import numpy as np

from uictest.rig import STEP, STOP_MEMORY, StopInputs

INSTANCE_MEMORY: Final[Any] = np.dtype(
    [("stop", STOP_MEMORY), ("time", "f8"), ("ended", "i8"), ("hold", "i4", 4), ("vent", "i4", 4)]
)
"""A stop, the time of the simulation, whether the stop has ended, and the commands as last set."""


@dataclass(frozen=True, slots=True)
class Variable:
    """One variable of the FMU.

    Attributes:
        name: in the model description.
        path: dotted, of its field in :data:`INSTANCE_MEMORY`.
        description: one line.
        unit: empty for a pure number.
        kind: of value.
        causality: as FMI has it.
        wheelset: which of several values in the field it is, from 0.
    """

    name: str
    path: str
    description: str
    unit: str = ""
    kind: Literal["real", "boolean", "integer"] = "real"
    causality: Literal["independent", "input", "output", "parameter"] = "output"
    wheelset: int = 0


def _of_wheelsets(*variables: Variable) -> Iterator[Variable]:
    for each in variables:
        for number in range(1, 5):
            name, description = f"{each.name}_{number}", f"{each.description}, wheelset {number}"
            yield replace(each, name=name, description=description, wheelset=number - 1)


VARIABLES: Final = (
    Variable("time", "time", "Time of the simulation", "s", causality="independent"),
    *_of_wheelsets(
        Variable("hold", "hold", "Holding magnet energised", "", "boolean", "input"),
        Variable(
            "vent",
            "vent",
            "Venting magnet energised; forbidden without the holding magnet",
            "",
            "boolean",
            "input",
        ),
        Variable(
            "wheel_speed", "stop.exchange.wheel_speed", "Circumferential, as its sensor shows it", "m/s"
        ),
        Variable(
            "speed_valid",
            "stop.exchange.speed_valid",
            "False where the speed sensor reports a fault",
            kind="boolean",
        ),
        Variable(
            "cylinder_pressure",
            "stop.exchange.cylinder_pressure",
            "Brake cylinder pressure above atmospheric, as its sensor shows it",
            "Pa",
        ),
    ),
    Variable(
        "brake_demand", "stop.exchange.brake_demand", "Share of full service; a brake is demanded above 0"
    ),
    Variable("train_speed", "stop.train.speed", "True speed of the train", "m/s"),
    Variable("distance", "stop.train.distance", "Distance since the brake command", "m"),
    Variable("brake_line_pressure", "stop.train.brake_line_pressure", "Above atmospheric", "Pa"),
    Variable("reservoir_pressure", "stop.train.reservoir_pressure", "Above atmospheric", "Pa"),
    Variable("stopped", "stop.car.stopped", "The train stands", kind="boolean"),
    Variable(
        "ended",
        "ended",
        "The train stands or the longest duration has passed; outputs stay",
        kind="boolean",
    ),
    Variable("braking_distance", "stop.car.stop_position", "0 until the train stands", "m"),
    Variable("braking_time", "stop.car.stop_time", "0 until the train stands", "s"),
    *_of_wheelsets(
        Variable("true_wheel_speed", "stop.modules.wheel_speed", "True circumferential speed", "m/s"),
        Variable("slide", "stop.modules.slide", "1 - true wheel speed / train speed; 0 below 1 m/s"),
        Variable("friction", "stop.modules.friction", "Friction coefficient of the rail under the wheelset"),
        Variable("adhesion", "stop.modules.adhesion", "Adhesion in use"),
        Variable("wheel_load", "stop.modules.wheel_load", "Load of one wheel", "N"),
        Variable("tank_pressure", "stop.modules.tank_pressure", "True pressure above atmospheric", "Pa"),
        Variable("clamping_force", "stop.modules.clamping_force", "Clamping force of one caliper", "N"),
        Variable("brake_torque", "stop.modules.brake_torque", "Brake torque of the wheelset", "N.m"),
    ),
    Variable("seed", "stop.parameters.seed", "Seed of the sensor noise", "", "integer", "parameter"),
)
"""In the order of their value references, from 0."""


_PLACES: Final = {
    "PARAMETERS_AT": "stop.parameters",
    "STOPPED_AT": "stop.car.stopped",
    "CYCLE_AT": "stop.car.cycle",
    "LONGEST_STOP_AT": "stop.parameters.cycles",
    "COMMANDED_HOLD_AT": "stop.exchange.hold",
    "COMMANDED_VENT_AT": "stop.exchange.vent",
    "TIME_AT": "time",
    "ENDED_AT": "ended",
    "HOLD_AT": "hold",
    "VENT_AT": "vent",
}
"""Name in C -> field of the memory of an instance."""
_STORAGES: Final = {"f8": "FLOAT64", "i4": "INT32", "i8": "INT64"}


def case_header(inputs: StopInputs) -> str:
    """Return `case.h` without the token that ties it to a model description."""
    lines = [
        f"#define MEMORY_SIZE {INSTANCE_MEMORY.itemsize}",
        f"#define STOP_SIZE {STOP_MEMORY.itemsize}",
        *(f"#define {name} {_place(path)[0]}" for name, path in _PLACES.items()),
        f"#define CYCLE_TIME {float(inputs.parameters['cycle_time']).hex()}",
        *_words("PARAMETERS", inputs.parameters),
        *_words("WHEELSET_PARAMETERS", inputs.wheelset_parameters),
        *_words("RAIL", inputs.rail),
        *_call(inputs.rail.shape[1]),
        *_variables(),
    ]
    return "".join(f"{line}\n" for line in lines)


def _words(name: str, values: Any) -> Iterator[str]:
    """Yield numbers bit by bit: decimal digits could round."""
    words = np.frombuffer(values.tobytes(), "<u8")
    yield f"static const uint64_t {name}[] = {{"
    yield from (f"    {word:#x}," for word in words)
    yield "};"


def _call(points: int) -> Iterator[str]:
    """Yield the call of the machine code, whose arguments are those of :data:`uictest.rig.STEP_ARGUMENTS`."""
    count = len(STOP_MEMORY.names)
    parts = ", ".join(f"(memory) + {STOP_MEMORY.fields[name][1]}" for name in STOP_MEMORY.names)
    pointers = ", ".join(["void *"] * count)
    kinds = f"{pointers}, const void *, const void *, int64_t, void *, void *, int64_t, int64_t, int64_t"
    yield f"int64_t {STEP}({kinds});"
    yield f"#define CARRY_OUT(memory) {STEP}({parts}, \\"
    yield f"    WHEELSET_PARAMETERS, RAIL, {points}, NULL, NULL, 0, 0, 0)"


def _variables() -> Iterator[str]:
    yield "typedef enum { REAL, BOOLEAN, INTEGER } Kind;"
    yield "typedef enum { INDEPENDENT, INPUT, OUTPUT, PARAMETER } Causality;"
    yield "typedef enum { FLOAT64, INT32, INT64 } Storage;"
    yield "typedef struct { Kind kind; Causality causality; Storage storage; size_t offset; } Variable;"
    yield "static const Variable VARIABLES[] = {"
    for each in VARIABLES:
        offset, storage = _place(each.path, each.wheelset)
        names = f"{each.kind.upper()}, {each.causality.upper()}, {_STORAGES[storage]}"
        yield f"    {{{names}, {offset}}}, /* {each.name} */"
    yield "};"


def _place(path: str, place: int = 0) -> tuple[int, str]:
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
