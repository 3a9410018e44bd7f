"""Parameters of the scenario as parameters of an FMU."""

from collections.abc import Mapping, Sequence
from math import prod
from typing import Any

from uictest.controllers.adapters.fmu.access import BoundVariable
from uictest.controllers.adapters.fmu.names import FLOATS
from uictest.controllers.adapters.fmu.slave import Slave
from uictest.controllers.adapters.instance import ControllerError
from uictest.controllers.declared import unknown_parameter


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
        return value.encode()
    if variable.type == "Boolean" and value in (False, True):
        return int(value)
    if isinstance(value, int | float) and not isinstance(value, bool):
        if variable.type in FLOATS:
            return float(value)
        _, c_type = slave.types[variable.type]
        if variable.type not in ("String", "Boolean") and _is_held(value, c_type):
            return int(value)
    raise ControllerError(f"has parameter {variable.name} of type {variable.type}, found {value!r}")


def _is_held(value: float, c_type: Any) -> bool:
    """Return whether a C type of whole numbers has a value."""
    return float(value).is_integer() and bool(c_type(int(value)).value == value)
