"""Variables of an FMU, each declared once, and their places in the memory of an instance."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, Literal


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
