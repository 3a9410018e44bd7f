"""Variables of an FMU, each declared once, and `model.h`: their places in the memory of an instance."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final, Literal

import numpy as np


@dataclass(frozen=True, slots=True)
class Variable:
    """One variable of an FMU.

    Attributes:
        name: in the model description.
        path: dotted, of its field in the memory of an instance.
        description: one line.
        unit: empty for a pure number.
        kind: of value.
        causality: as FMI has it.
        wheelset: which of several values in the field it is, from 0.
        start: value before anybody sets it, as FMI writes it; empty for what is calculated.
        range: smallest and largest value of a parameter; None where any is accepted.
    """

    name: str
    path: str
    description: str
    unit: str = ""
    kind: Literal["real", "boolean", "integer"] = "real"
    causality: Literal["independent", "input", "output", "parameter"] = "output"
    wheelset: int = 0
    start: str = ""
    range: tuple[float, float] | None = None


def of_wheelsets(*variables: Variable) -> Iterator[Variable]:
    """Yield each variable four times, numbered from 1."""
    for each in variables:
        for number in range(1, 5):
            name, description = f"{each.name}_{number}", f"{each.description}, wheelset {number}"
            yield replace(each, name=name, description=description, wheelset=number - 1)


_STORAGES: Final = {"f8": "FLOAT64", "i4": "INT32", "u4": "INT32", "i8": "INT64"}


def model_header(
    token: str, memory: Any, variables: Sequence[Variable], places: Mapping[str, str], *, can_save: bool
) -> str:
    """Return `model.h`.

    Args:
        token: ties the library to a model description.
        memory: layout of the memory of an instance.
        variables: in the order of their value references.
        places: name in C -> path of a field, besides those of the variables.
        can_save: whether a copy of the memory is a copy of the simulation.
    """
    lines = [
        f'#define TOKEN "{token}"',
        f"#define CAN_SAVE {int(can_save)}",
        f"#define MEMORY_SIZE {memory.itemsize}",
        *(f"#define {name} {place_of(memory, path)[0]}" for name, path in places.items()),
        "#define VARIABLE_ROWS \\",
        *(f"    {{{', '.join(_row(memory, each))}}}, \\" for each in variables),
    ]
    return "".join(f"{line}\n" for line in lines) + "\n"


def _row(memory: Any, variable: Variable) -> tuple[str, ...]:
    offset, storage = place_of(memory, variable.path, variable.wheelset)
    lowest, highest = map(repr, variable.range or ()) if variable.range else ("-HUGE_VAL", "HUGE_VAL")
    words = variable.kind.upper(), variable.causality.upper(), _STORAGES[storage]
    return c_text(variable.name), *words, str(offset), lowest, highest


def c_text(text: str) -> str:
    """Return a text as C writes it, in which JSON has escaped all but printable ASCII."""
    return json.dumps(json.dumps(text)[1:-1])


def c_words(name: str, values: Any) -> Iterator[str]:
    """Yield numbers bit by bit: decimal digits could round."""
    words = np.frombuffer(values.tobytes(), "<u8")
    yield f"static const uint64_t {name}[] = {{"
    yield from (f"    {word:#x}," for word in words)
    yield "};"


def place_of(memory: Any, path: str, place: int = 0) -> tuple[int, str]:
    """Return offset and storage of a field; of several, in an array of numbers or of records, one."""
    layout, offset = memory, 0
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
