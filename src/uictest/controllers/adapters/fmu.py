"""Controllers as FMUs: co-simulation, FMI 2.0 or 3.0, by our names of variables or by those of the scenario.

In every controller cycle the inputs are set, the FMU makes one step of one cycle, and its outputs are read:
the answer belongs to the inputs of the same cycle. An FMU may answer a cycle late, where its tool evaluates
inputs at the start of the next step: that is a property of the FMU, and the stop shows it. An FMU with an
output that version 2 of the contract adds is of that version; any other is of version 1, and what only
version 2 has is then not set.

An FMU is instantiated once per thread and reset between stops: some tools' FMUs fail after a thousand
instances. Each thread unpacks a copy of its library, so that static variables are not shared.
"""

from __future__ import annotations

import math
import sys
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import redirect_stdout
from dataclasses import dataclass
from importlib.util import find_spec
from math import prod
from pathlib import Path
from threading import local
from typing import TYPE_CHECKING, Any, Final

from uictest.controllers.adapters.instance import CalledInstance, ControllerError, OnlyOneError
from uictest.controllers.declared import ControllerProgram, unknown_parameter
from uictest.controllers.interface import WHEELSETS, Config, Inputs, Outputs

if TYPE_CHECKING:
    from uictest.controllers.adapters.fmu_slave import Slave

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


INPUTS: Final = (
    Declared("wheel_speed", "input", WHEELSETS, is_needed=True),
    Declared("speed_valid", "input", WHEELSETS, is_whole=True),
    Declared("cylinder_pressure", "input", WHEELSETS),
    Declared("brake_demand", "input"),
    Declared("time", "input"),
    Declared("cycle", "input", is_whole=True),
)
"""Set in every cycle."""
CONSTANTS: Final = (
    Declared("initial_speed", "parameter"),
    Declared("cycle_time", "parameter"),
    Declared("wheel_radius", "parameter", WHEELSETS),
)
"""Set before a stop."""
OUTPUTS: Final = (
    Declared("hold", "output", WHEELSETS, is_whole=True, is_needed=True),
    Declared("vent", "output", WHEELSETS, is_whole=True, is_needed=True),
    Declared("reference_speed", "output"),
    Declared("diagnosis", "output", is_whole=True),
)
"""Read in every cycle."""
INPUTS_2: Final = (
    Declared("dynamic_brake", "input", WHEELSETS),
    Declared("axle_load", "input"),
    Declared("brake_command", "input"),
    Declared("train_speed", "input"),
    Declared("train_speed_valid", "input", is_whole=True),
    Declared("acceleration", "input"),
    Declared("acceleration_valid", "input", is_whole=True),
)
"""Set in every cycle as well, in version 2."""
OUTPUTS_2: Final = (
    Declared("dynamic_reduction", "output", WHEELSETS),
    Declared("sand_request", "output", WHEELSETS, is_whole=True),
    Declared("track_brake_request", "output", is_whole=True),
)
"""Read in every cycle as well, in version 2: having one of them makes an FMU one of that version."""
_BITS: Final = 0xFFFF_FFFF


class _Slaves:
    """Instances of one FMU: those that no stop uses, and those in use, of which the cars of a train need
    several.
    """

    def __init__(self) -> None:
        self.idle: list[Slave] = []
        self.in_use: list[Slave] = []

    def take(self, program: ControllerProgram, load: Callable[[Path, str], Slave]) -> Slave:
        """Return an idle one, or load one. Raises ControllerError."""
        path = Path(program.location)
        others = self.in_use
        if others and others[0].description.coSimulation.canBeInstantiatedOnlyOncePerProcess:
            raise OnlyOneError(
                f"{path.name} can be instantiated only once in a process, so that only one car of a train can"
                " have it"
            )
        slave = self.idle.pop() if self.idle else load(path, program.sha256)
        self.in_use.append(slave)
        return slave

    def give_back(self, slave: Slave) -> None:
        """Keep one for the next stop; one that has failed is released."""
        self.in_use.remove(slave)
        if slave.usable:
            self.idle.append(slave)
        else:
            slave.release()


class _OfThread(local):
    """The FMUs of a thread, by path and SHA-256."""

    def __init__(self) -> None:
        self.slaves: defaultdict[tuple[str, str], _Slaves] = defaultdict(_Slaves)


_of_thread = _OfThread()


def open_controller(program: ControllerProgram, config: Config) -> FmuInstance:
    """Take an idle FMU of this file, or load one. Raises ControllerError."""
    if find_spec("fmpy") is None:
        raise ControllerError("controllers as FMUs need FMPy: pip install 'uictest[fmu]'")
    # FMPy is an extra. It prints where a part of it does not load; standard output is for results.
    with redirect_stdout(sys.stderr):
        from uictest.controllers.adapters.fmu_slave import load_slave
    slaves = _of_thread.slaves[program.location, program.sha256]
    slave = slaves.take(program, load_slave)
    try:
        return FmuInstance(slave, slaves, config, program.options.get("variables", {}))
    except ControllerError as error:
        slaves.give_back(slave)
        raise ControllerError(f"{Path(program.location).name} {error}") from error


class FmuInstance(CalledInstance):
    """An FMU, for one stop."""

    def __init__(self, slave: Slave, slaves: _Slaves, config: Config, names: Mapping[str, str]) -> None:
        super().__init__()
        slave.check_step_size(config.cycle_time)
        known = [declared.name for declared in (*INPUTS, *CONSTANTS, *OUTPUTS, *INPUTS_2, *OUTPUTS_2)]
        for name in names:
            if name not in known:
                raise ControllerError(f"has no use for variables.{name}; the keys are {', '.join(known)}")
        self.version = slave.description.version or ""
        self._slave = slave
        self._slaves = slaves
        self._config = config
        self.contract = 2 if bind(slave.description, OUTPUTS_2, names) else 1
        added = (INPUTS_2, OUTPUTS_2) if self.contract > 1 else ((), ())
        for each in INPUTS_2:
            if self.contract == 1 and each.name in names:
                needed = " or ".join(output.name for output in OUTPUTS_2)
                raise ControllerError(f"has no output {needed}: without one variables.{each.name} has no use")
        inputs, constants, outputs = (
            bind(slave.description, declared, names)
            for declared in ((*INPUTS, *added[0]), CONSTANTS, (*OUTPUTS, *added[1]))
        )
        parameters, self._parameter_values = bound_parameters(slave, config.parameters)
        self._inputs = grouped(slave, inputs)
        self._parameters = grouped(slave, [*constants, *parameters])
        self._outputs = grouped(slave, outputs)
        self._magnets = {name: _labels_by_wheelset(outputs, name) for name in ("hold", "vent")}

    def reset(self) -> None:
        """Set all variables to their start values, parameters to those of the scenario, and initialise.

        The inputs are at first those of a train that rolls with its brakes released.
        """
        config = self._config
        constants = {declared.name: _as_sequence(getattr(config, declared.name)) for declared in CONSTANTS}
        speeds, pressures = (config.initial_speed,) * WHEELSETS, (0.0,) * WHEELSETS
        with self._slave.checked():
            self._slave.reset()
            _set(self._parameters, constants | self._parameter_values)
            with self._slave.initialising():
                self._set_inputs(Inputs(0, 0.0, speeds, (True,) * WHEELSETS, pressures, 0.0))

    def step(self, inputs: Inputs) -> Outputs:
        """Set the inputs, make a step of one cycle, read the outputs."""
        read: dict[str, list[Any]] = {
            declared.name: [0] * declared.count for declared in (*OUTPUTS, *OUTPUTS_2)
        }
        read["reference_speed"] = [math.nan]
        with self._slave.checked():
            self._set_inputs(inputs)
            self._slave.step(inputs.time, self._config.cycle_time)
            for group in self._outputs:
                group.get(read)
        hold, vent = (_magnets(read[name], self._magnets[name]) for name in ("hold", "vent"))
        answer = Outputs(hold, vent, read["reference_speed"][0], _bits(read["diagnosis"][0]))
        if self.contract > 1:
            answer.dynamic_reduction, answer.sand_request = read["dynamic_reduction"], read["sand_request"]
            answer.track_brake_request = read["track_brake_request"][0]
        return answer

    def close(self) -> None:
        """Keep the FMU for the next stop of this thread; one that has failed is released."""
        self._slaves.give_back(self._slave)

    def _set_inputs(self, inputs: Inputs) -> None:
        values = {
            declared.name: _as_sequence(getattr(inputs, declared.name)) for declared in (*INPUTS, *INPUTS_2)
        }
        _set(self._inputs, values)


def _set(groups: Sequence[VariableGroup], values: Values) -> None:
    for group in groups:
        group.set(values)


def _as_sequence(value: Any) -> Sequence[Any]:
    return value if isinstance(value, tuple) else (value,)


def _labels_by_wheelset(outputs: Sequence[BoundVariable], name: str) -> list[str]:
    of_place = {
        number: bound.label(index)
        for bound in outputs
        for index, (quantity, number) in enumerate(bound.slots)
        if quantity == name
    }
    return [of_place[number] for number in range(WHEELSETS)]


def _magnets(values: Sequence[Any], labels: Sequence[str]) -> list[int]:
    for value, label in zip(values, labels, strict=True):
        if value not in (0, 1):
            raise ControllerError(f"{label} is {value!r}, expected 0 or 1")
    return [int(value) for value in values]


def _bits(value: Any) -> int:
    """Return 32 bits; an Integer of FMI 2.0 has a sign."""
    if not math.isfinite(value) or value != int(value):
        raise ControllerError(f"diagnosis is {value!r}, expected a whole number of 32 bits")
    return int(value) & _BITS


Slot = tuple[str, int]
"""Position of a value: our name of the quantity, number of the wheelset from 0."""
Values = Mapping[str, Sequence[Any]]


@dataclass(frozen=True, slots=True)
class BoundVariable:
    """A variable of an FMU, as FMPy describes it, and the slots of its elements."""

    variable: Any
    slots: tuple[Slot, ...]

    def label(self, element: int) -> str:
        """Return the FMU's name of an element, counted from 0."""
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
        self._slave.set(self._kind, self._references, [values[name][number] for name, number in self._slots])

    def get(self, values: Mapping[str, list[Any]]) -> None:
        """Read the variables."""
        read = self._slave.get(self._kind, self._references, len(self._slots))
        for (name, number), value in zip(self._slots, read, strict=True):
            values[name][number] = value


def grouped(slave: Slave, variables: Iterable[BoundVariable]) -> list[VariableGroup]:
    """Return variables by their types."""
    by_type: defaultdict[str, list[BoundVariable]] = defaultdict(list)
    for variable in variables:
        by_type[slave.types[variable.variable.type]].append(variable)
    return [VariableGroup(slave, kind, members) for kind, members in by_type.items()]


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
    matching = next((names for names in candidates if all(own_name in variables for own_name in names)), None)
    if matching is None:
        if name is None and not quantity.is_needed:
            return []
        raise ControllerError(_missing_variable_message(variables, quantity, name, candidates[0]))
    chosen = [variables[names] for names in matching]
    unfit = next((names for names in chosen if not quantity.fits(names)), None)
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
            yield [template.replace("%d", str(first + number)) for number in range(quantity.count)]
    else:
        yield [template]
    if name is None and quantity.count > 1:
        yield [quantity.name]


def _with_slots(quantity: Declared, variables: Sequence[Any]) -> list[BoundVariable]:
    slots = [(quantity.name, number) for number in range(quantity.count)]
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


def _missing_variable_message(
    variables: Mapping[str, Any], quantity: Declared, name: str | None, names: list[str]
) -> str:
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
    parameter_variables = {
        variable.name: variable
        for variable in slave.description.modelVariables
        if variable.causality == "parameter"
    }
    bound: list[BoundVariable] = []
    values: dict[str, Sequence[Any]] = {}
    for name, value in parameters.items():
        if name not in parameter_variables:
            raise ControllerError(f"has {unknown_parameter(name, tuple(parameter_variables))}")
        values[name] = _values(slave, parameter_variables[name], value)
        bound.append(
            BoundVariable(
                parameter_variables[name], tuple((name, number) for number in range(len(values[name])))
            )
        )
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
