"""Parameters that are known only once a program runs: of the built-in form, and as a program states them."""

import json
import math
import re
from collections.abc import Mapping, Sequence
from fractions import Fraction
from types import SimpleNamespace
from typing import Any, Final, NamedTuple

from uictest.controllers.adapters.instance import ControllerError
from uictest.controllers.contract import Controller, DeclaredParameter
from uictest.controllers.declared import nothing_declared, parameter_problems, unknown_parameter
from uictest.controllers.program import ControllerProgram
from uictest.core.units import KINDS

_WRITTEN: Final = re.compile(r"\s*([-+]?[0-9]+(?:\.[0-9]+)?(?:[eE][-+]?[0-9]{1,3})?)\s*(\S.*?)?\s*")


class StatedDeclaration(NamedTuple):
    """A declaration that a program has stated itself."""

    default: Any = None
    unit: str = ""
    range: Sequence[float] | None = None
    description: str = ""


def reject_undeclared(program: ControllerProgram, stated: str | None) -> None:
    """Raise ControllerError where a program that runs is given what it does not declare.

    `stated` is the JSON in which it states its parameters, None where it states none.
    """
    mode, given = program.options.get("parameters"), json.loads(program.parameters)
    if stated is None:
        problems = [nothing_declared(given)] if mode == "asked" and given else []
    else:
        problems = [*parameter_problems(_stated(stated), given, free=mode == "free")]
    if problems:
        raise ControllerError("; ".join(f"controller.parameters.{each.name}: {each}" for each in problems))


def _stated(text: str) -> dict[str, StatedDeclaration]:
    try:
        stated = {str(name): StatedDeclaration(**each) for name, each in json.loads(text).items()}
        for low, high in (each.range for each in stated.values() if each.range is not None):
            float(low), float(high)  # raise what is no number
        return stated
    except (ValueError, TypeError, AttributeError) as error:
        form = '{"NAME": {"default": 1.0, "unit": "s", "range": [0, 2]}}'
        raise ControllerError(f"its parameters are not of the form {form}: {error}") from None


def parameter_values(
    controller: Controller, written: Mapping[str, Any], cycle_time: float
) -> dict[str, float]:
    """Return the value of every declared parameter, SI units; that of the cycle time is given.

    A value is a number in the SI unit, or a text with a unit such as ``0.8 m/s``. Raises ControllerError.
    """
    declared = {name: each for name, each in controller.declared_parameters().items() if name != "cycle_time"}
    for name in written:
        if name not in declared:
            raise ControllerError(str(unknown_parameter(name, tuple(declared))))
    missing = [name for name in declared if name not in written]
    if missing:
        raise ControllerError(f"parameters without a value: {', '.join(missing)}")
    values = {name: _value(name, written[name], declared[name]) for name in declared}
    values["cycle_time"] = cycle_time
    _reject_conflicts(controller, values, {**written, "cycle_time": f"{cycle_time:g} s"})
    return values


def _value(name: str, written: Any, declared: DeclaredParameter) -> float:
    value = _in_si(name, written, declared)
    if not math.isfinite(value):
        raise ControllerError(f"{name} is {written}, expected a finite number")
    for bound, outside in ((declared.at_least, value.__lt__), (declared.at_most, value.__gt__)):
        if outside(_in_si(name, bound, declared)):
            limits = f"from {declared.at_least} to {declared.at_most}"
            raise ControllerError(f"{name} is {written}, expected a {declared.kind} {limits}")
    return value


def _in_si(name: str, written: Any, declared: DeclaredParameter) -> float:
    kind = KINDS[declared.kind]
    if isinstance(written, int | float) and not isinstance(written, bool):
        return float(written)
    match = _WRITTEN.fullmatch(str(written))
    unit = kind.units.get(match[2] or "") if match else None
    if match is None or unit is None:
        units = ", ".join(kind.units) or "none"
        accepted = f"a number in {kind.canonical} or a text with a unit ({units})"
        raise ControllerError(f"{name} is {written!r}, expected {accepted}")
    return float(Fraction(match[1]) * unit.factor + unit.offset)


def _reject_conflicts(
    controller: Controller, values: Mapping[str, float], written: Mapping[str, Any]
) -> None:
    for conflict in controller.conflicts(SimpleNamespace(**values)):
        message = conflict.message.format(**written)
        raise ControllerError(f"{conflict.parameter} is {written[conflict.parameter]}: {message}")
