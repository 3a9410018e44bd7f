"""Variables of an FMU that are set or read by one call."""

from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from ctypes import c_uint
from dataclasses import dataclass
from typing import Any

from uictest.controllers.adapters.fmu.slave import Slave

Slot = tuple[str, int]
"""Where a value stands: our name of the quantity, number of the wheelset from 0."""
Values = Mapping[str, Sequence[Any]]


@dataclass(frozen=True, slots=True)
class BoundVariable:
    """A variable of an FMU, as FMPy describes it, and the slots of its elements."""

    variable: Any
    slots: tuple[Slot, ...]

    def label(self, element: int) -> str:
        """Return what the FMU calls an element, counted from 0."""
        return f"{self.variable.name}[{element + 1}]" if len(self.slots) > 1 else str(self.variable.name)


@dataclass(frozen=True, slots=True)
class VariableGroup:
    """Variables of one type with the memory that the FMU reads or writes."""

    slots: tuple[Slot, ...]
    memory: Any
    call: Callable[[], object]

    def set(self, values: Values) -> None:
        """Set the variables."""
        memory = self.memory
        for index, (name, place) in enumerate(self.slots):
            memory[index] = values[name][place]
        self.call()

    def get(self, values: Mapping[str, list[Any]]) -> None:
        """Read the variables."""
        self.call()
        memory = self.memory
        for index, (name, place) in enumerate(self.slots):
            values[name][place] = memory[index]


def grouped(slave: Slave, verb: str, variables: Iterable[BoundVariable]) -> list[VariableGroup]:
    """Return variables by their types; ``verb`` is Set or Get."""
    by_type: defaultdict[tuple[str, Any], list[BoundVariable]] = defaultdict(list)
    for each in variables:
        by_type[slave.types[each.variable.type]].append(each)
    return [_group(slave, verb, kind, members) for kind, members in by_type.items()]


def _group(slave: Slave, verb: str, kind: tuple[str, Any], members: Sequence[BoundVariable]) -> VariableGroup:
    name, c_type = kind
    references = (c_uint * len(members))(*(each.variable.valueReference for each in members))
    slots = tuple(slot for each in members for slot in each.slots)
    memory = (c_type * len(slots))()
    return VariableGroup(slots, memory, slave.access(verb, name, references, memory))
