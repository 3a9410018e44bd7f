"""The header that is generated with every FMU: the case as numbers, and the layout of an instance."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any, Final

import numpy as np

from uictest.api.rig_fmu.variables import INSTANCE_MEMORY, Variable, place_of, variables
from uictest.rig import STEP, STOP_MEMORY, StopInputs

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
        *_sizes_and_places(),
        f"#define CYCLE_TIME {float(inputs.parameters['cycle_time']).hex()}",
        *_words("PARAMETERS", inputs.parameters),
        *_words("WHEELSET_PARAMETERS", inputs.wheelset_parameters),
        *_words("RAIL", inputs.rail),
        *_call(inputs.rail.shape[1]),
        *_variables(variables()),
    ]
    return "".join(f"{line}\n" for line in lines)


def _sizes_and_places() -> Iterator[str]:
    yield f"#define MEMORY_SIZE {INSTANCE_MEMORY.itemsize}"
    yield f"#define STOP_SIZE {STOP_MEMORY.itemsize}"
    for name, path in _PLACES.items():
        yield f"#define {name} {place_of(path)}"


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


def _variables(declared: Iterable[Variable]) -> Iterator[str]:
    yield "typedef enum { REAL, BOOLEAN, INTEGER } Kind;"
    yield "typedef enum { INDEPENDENT, INPUT, OUTPUT, PARAMETER } Causality;"
    yield "typedef enum { FLOAT64, INT32, INT64 } Storage;"
    yield "typedef struct { Kind kind; Causality causality; Storage storage; size_t offset; } Variable;"
    yield "static const Variable VARIABLES[] = {"
    for each in declared:
        names = f"{each.kind.upper()}, {each.causality.upper()}, {_STORAGES[each.storage]}"
        yield f"    {{{names}, {each.offset}}}, /* {each.name} */"
    yield "};"
