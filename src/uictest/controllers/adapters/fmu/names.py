"""Find the variables of an FMU by name, and set or read those of one type by one call."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import prod
from typing import Any, Final

from uictest.controllers.adapters.errors import ControllerError
from uictest.controllers.adapters.fmu.slave import Slave
from uictest.controllers.declared import unknown_parameter
from uictest.controllers.interface import WHEELSETS

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


class VariableGroup:
    """Variables of one type, named as in functions."""

    def __init__(self, slave: Slave, kind: str, members: Sequence[BoundVariable]) -> None:
        self._slave = slave
        self._kind = kind
        self._references = [each.variable.valueReference for each in members]
        self._slots = [slot for each in members for slot in each.slots]

    def set(self, values: Values) -> None:
        """Set the variables."""
        self._slave.set(self._kind, self._references, [values[name][place] for name, place in self._slots])

    def get(self, values: Mapping[str, list[Any]]) -> None:
        """Read the variables."""
        read = self._slave.get(self._kind, self._references, len(self._slots))
        for (name, place), value in zip(self._slots, read, strict=True):
            values[name][place] = value


def grouped(slave: Slave, variables: Iterable[BoundVariable]) -> list[VariableGroup]:
    """Return variables by their types."""
    by_type: defaultdict[str, list[BoundVariable]] = defaultdict(list)
    for each in variables:
        by_type[slave.types[each.variable.type]].append(each)
    return [VariableGroup(slave, kind, members) for kind, members in by_type.items()]


FLOATS: Final = ("Real", "Float64", "Float32")
_WHOLE: Final = ("Integer", "Enumeration", "Boolean")
_SHOWN: Final = 8
"""Names that a message lists at most; chosen."""
_FIRST_NUMBERS: Final = (1, 0)
"""Wheelsets are counted from 1; a tool may count from 0."""


@dataclass(frozen=True, slots=True)
class Declared:
    """A quantity that a controller is given or answers.

    Attributes:
        name: ours.
        causality: of its variables in an FMU; what is set as a parameter may be an input as well.
        count: how many there are.
        is_whole: whether a variable of whole numbers or truth values can hold it.
        is_needed: whether an FMU must have it.
    """

    name: str
    causality: str
    count: int = 1
    is_whole: bool = False
    is_needed: bool = False

    def fits(self, variable: Any) -> bool:
        """Return whether a variable has the causality and a type for it."""
        causalities = (self.causality, "input") if self.causality == "parameter" else (self.causality,)
        whole = self.is_whole and ("Int" in variable.type or variable.type in _WHOLE)
        return variable.causality in causalities and (variable.type in FLOATS or whole)


def bind(description: Any, declared: Iterable[Declared], names: Mapping[str, str]) -> list[BoundVariable]:
    """Return the variables of some quantities.

    Args:
        description: of the FMU, as FMPy reads it.
        declared: the quantities.
        names: names of variables by ours; %d stands for the number of the wheelset.

    Raises:
        ControllerError: for a variable that is needed or named and not there, or cannot hold the quantity.
    """
    variables = {each.name: each for each in description.modelVariables}
    return [bound for quantity in declared for bound in _bind(variables, quantity, names.get(quantity.name))]


def _bind(variables: Mapping[str, Any], quantity: Declared, name: str | None) -> list[BoundVariable]:
    candidates = list(_candidates(quantity, name))
    found = next((each for each in candidates if all(own in variables for own in each)), None)
    if found is None:
        if name is None and not quantity.is_needed:
            return []
        raise ControllerError(_missing(variables, quantity, name, candidates[0]))
    chosen = [variables[each] for each in found]
    unfit = next((each for each in chosen if not quantity.fits(each)), None)
    if unfit is not None and name is None and not quantity.is_needed:
        return []
    if unfit is not None:
        types = "a number or truth value" if quantity.is_whole else "Real or Float64"
        found_type = f"has {unfit.name} as {unfit.causality} of type {unfit.type}"
        raise ControllerError(f"{found_type}, expected {quantity.causality} of type {types}")
    return _with_slots(quantity, chosen)


def _candidates(quantity: Declared, name: str | None) -> Iterator[list[str]]:
    """Yield the names of variables that may hold a quantity, each as a list of one for all or of one each."""
    template = name or (quantity.name if quantity.count == 1 else f"{quantity.name}_%d")
    if "%d" in template and quantity.count > 1:
        for first in _FIRST_NUMBERS:
            yield [template.replace("%d", str(first + place)) for place in range(quantity.count)]
    else:
        yield [template]
    if name is None and quantity.count > 1:
        yield [quantity.name]


def _with_slots(quantity: Declared, variables: Sequence[Any]) -> list[BoundVariable]:
    slots = [(quantity.name, place) for place in range(quantity.count)]
    if len(variables) == quantity.count:
        for variable in variables:
            _check_size(variable, 1)
        return [BoundVariable(variable, (slot,)) for variable, slot in zip(variables, slots, strict=True)]
    _check_size(variables[0], quantity.count)
    return [BoundVariable(variables[0], tuple(slots))]


def _check_size(variable: Any, expected: int) -> None:
    size = prod(variable.shape or ())
    if size != expected:
        hint = "; write %d for the number of the wheelset" if expected == WHEELSETS and size == 1 else ""
        values = "one value" if size == 1 else f"{size} values"
        raise ControllerError(f"has {values} in {variable.name}, expected {expected}{hint}")


def _missing(variables: Mapping[str, Any], quantity: Declared, name: str | None, names: list[str]) -> str:
    there = [each.name for each in variables.values() if each.causality == quantity.causality]
    absent = next(each for each in names if each not in variables)
    shown = ", ".join(there[:_SHOWN]) or "none"
    more = f" and {len(there) - _SHOWN} more" if len(there) > _SHOWN else ""
    number = "_%d" if quantity.count > 1 else ""
    hint = "" if name else f"; name it: variables: {{{quantity.name}: its_name{number}}}"
    return f"has no {quantity.causality} {absent}; its {quantity.causality}s: {shown}{more}{hint}"


def bound_parameters(
    slave: Slave, parameters: Mapping[str, Any]
) -> tuple[list[BoundVariable], dict[str, Sequence[Any]]]:
    """Return the FMU's parameters that a scenario sets, and their values by name.

    Raises:
        ControllerError: for a parameter that the FMU does not have, or a value that it cannot hold.
    """
    own = {each.name: each for each in slave.description.modelVariables if each.causality == "parameter"}
    bound: list[BoundVariable] = []
    values: dict[str, Sequence[Any]] = {}
    for name, value in parameters.items():
        if name not in own:
            raise ControllerError(f"has {unknown_parameter(name, tuple(own))}")
        values[name] = _values(slave, own[name], value)
        bound.append(BoundVariable(own[name], tuple((name, place) for place in range(len(values[name])))))
    return bound, values


def _values(slave: Slave, variable: Any, value: Any) -> list[Any]:
    elements = list(value) if isinstance(value, list | tuple) else [value]
    size = prod(variable.shape or ())
    if len(elements) != size:
        held = "one value" if size == 1 else f"{size} values"
        raise ControllerError(f"has {held} in parameter {variable.name}, found {len(elements)}")
    return [_value(slave, variable, element) for element in elements]


def _value(slave: Slave, variable: Any, value: Any) -> Any:
    if variable.type not in slave.types:
        raise ControllerError(f"has parameter {variable.name} of type {variable.type}, which cannot be set")
    if variable.type == "String" and isinstance(value, str):
        return value
    if variable.type == "Boolean" and value in (False, True):
        return int(value)
    if isinstance(value, int | float) and not isinstance(value, bool):
        if variable.type in FLOATS:
            return float(value)
        if variable.type not in ("String", "Boolean") and slave.holds(slave.types[variable.type], value):
            return int(value)
    raise ControllerError(f"has parameter {variable.name} of type {variable.type}, found {value!r}")
