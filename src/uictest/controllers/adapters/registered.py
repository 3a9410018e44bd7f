"""Controllers of installed packages: a class as in a Python file, or functions in the built-in form."""

import json
import math
import re
from collections.abc import Callable, Mapping
from fractions import Fraction
from functools import cache
from importlib import import_module
from types import SimpleNamespace
from typing import Any, Final, NamedTuple

import numpy as np

from uictest.controllers.adapters.errors import ControllerError
from uictest.controllers.adapters.instance import (
    ControllerInstance,
    checked_contract,
    reason_of,
    reject_undeclared,
)
from uictest.controllers.adapters.python_class import object_of
from uictest.controllers.contract import Controller, DeclaredParameter
from uictest.controllers.declared import (
    ControllerProgram,
    installed,
    installed_names,
    package_of,
    unknown_parameter,
)
from uictest.controllers.interface import INPUTS, OUTPUTS, WHEELSETS, Config
from uictest.core import lanes
from uictest.core.physics import FILL, VENT, fma
from uictest.core.record import layout_of
from uictest.core.units import KINDS

_WRITTEN: Final = re.compile(r"\s*([-+]?[0-9]+(?:\.[0-9]+)?(?:[eE][-+]?[0-9]{1,3})?)\s*(\S.*?)?\s*")


def open_controller(program: ControllerProgram, config: Config) -> ControllerInstance:
    """Import what a package has registered, and create a controller for one stop. Raises ControllerError."""
    registered, package = _loaded(program.location)
    if isinstance(registered, Controller):
        return CompiledInstance(registered, json.loads(program.parameters), config, package)
    if isinstance(registered, type):
        reject_undeclared(program, None)
        return object_of(registered, config, package)
    kind = type(registered).__name__
    raise ControllerError(
        f"{program.location} of {package} is of type {kind}; register a class or a Controller"
    )


@cache
def _loaded(name: str) -> tuple[Any, str]:
    """Return what is registered under a name, and the package it comes from."""
    entries = installed(name)
    if not entries:
        known = ", ".join(installed_names()) or "none"
        raise ControllerError(f"no installed package has registered {name!r}; registered: {known}")
    if len(entries) > 1:
        packages = " and ".join(map(package_of, entries))
        raise ControllerError(f"{name} is registered by {packages}: uninstall one of them")
    package = package_of(entries[0])
    try:
        return entries[0].load(), package
    except (Exception, SystemExit) as error:
        raise ControllerError(f"{name} of {package} cannot be imported: {reason_of(error)}") from error


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
    shown = {**written, "cycle_time": f"{cycle_time:g} s"}
    for conflict in controller.conflicts(SimpleNamespace(**values)):
        reason = conflict.message.format(**shown)
        raise ControllerError(f"{conflict.parameter} is {shown[conflict.parameter]}: {reason}")
    return values


def _value(name: str, written: Any, declared: DeclaredParameter) -> float:
    value = in_si(name, written, declared)
    if not math.isfinite(value):
        raise ControllerError(f"{name} is {written}, expected a finite number")
    for bound, outside in ((declared.at_least, value.__lt__), (declared.at_most, value.__gt__)):
        if outside(in_si(name, bound, declared)):
            limits = f"from {declared.at_least} to {declared.at_most}"
            raise ControllerError(f"{name} is {written}, expected a {declared.kind} {limits}")
    return value


def in_si(name: str, written: Any, declared: DeclaredParameter) -> float:
    """Return a value as a user writes it in the SI unit. Raises ControllerError for one that is none."""
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


_OPTIONS: Final[dict[str, Any]] = {"error_model": "numpy", "nogil": True}
"""As the rig is compiled: the same source gives the same bits."""


class CompiledInstance(ControllerInstance):
    """The memory of a controller, and the compiled functions that work on it."""

    runs_beside_others = True

    def __init__(
        self, controller: Controller, parameters: Mapping[str, Any], config: Config, version: str
    ) -> None:
        self.version = version
        self.contract = checked_contract(controller.contract, f"{controller.name} is of contract version")
        self._memory: Any = np.zeros(1, memory_of(controller))
        values = parameter_values(controller, parameters, config.cycle_time)
        for name, value in values.items():
            self._memory["parameters"][name] = value
        self._memory["initial_speed"] = config.initial_speed
        try:
            self._functions = _compiled(controller)
        except Exception as error:
            raise ControllerError(f"{controller.name} cannot be compiled: {reason_of(error)}") from error
        self.step_address = int(self._functions.step.address)
        self.handle = int(self._memory.__array_interface__["data"][0])

    def reset(self) -> None:
        """Begin a stop."""
        for name in ("train", "wheelsets"):
            self._memory[name] = np.zeros(1, self._memory.dtype)[name]
        self._functions.begin.ctypes(self.handle)


class _Functions(NamedTuple):
    begin: Any
    step: Any


def memory_of(controller: Controller) -> Any:
    """Return the layout of what a controller remembers, and behind it of what it is given."""
    return np.dtype(
        [
            ("wheelsets", layout_of(controller.wheelset_memory), WHEELSETS),
            ("train", layout_of(controller.train_memory)),
            ("parameters", layout_of(controller.parameters)),
            ("initial_speed", "f8"),
        ]
    )


@cache
def _compiled(controller: Controller) -> _Functions:
    """Compile a controller, which takes some seconds, once per process."""
    numba: Any = import_module("numba")
    # Not as the rig's own functions, which end the process where they would raise an error.
    begin_at, step_at = functions_of_addresses(controller, numba.njit(**_OPTIONS))
    address, status = numba.int64, numba.int32
    return _Functions(
        numba.cfunc(status(address), **_OPTIONS)(begin_at),
        numba.cfunc(status(address, address, address), **_OPTIONS)(step_at),
    )


def functions_of_addresses(controller: Controller, compile_inner: Callable[[Any], Any]) -> tuple[Any, Any]:
    """Return what begins a stop and what decides on a cycle, ready to be compiled.

    The one takes the address of the memory that :func:`memory_of` lays out, the other that of inputs and
    outputs as well. Both return 0.

    Args:
        controller: in the built-in form.
        compile_inner: compiles a function that only compiled code calls.
    """
    memory = memory_of(controller)
    train_place, parameters_place, speed_place = (
        memory.fields[name][1] for name in ("train", "parameters", "initial_speed")
    )
    size = layout_of(controller.wheelset_memory).itemsize
    train_at = lanes.record_at(memory["train"])
    wheelset_at = lanes.record_at(layout_of(controller.wheelset_memory))
    parameters_at = lanes.record_at(memory["parameters"])
    number_at = lanes.record_at(np.dtype([("value", "f8")]))
    inputs_at, outputs_at = lanes.record_at(INPUTS), lanes.record_at(OUTPUTS)
    begin, decide = _translated(controller, compile_inner)
    give, answer = (compile_inner(each) for each in _VERSIONS[controller.contract])

    def four_wheelsets(handle: int) -> Any:
        return (
            wheelset_at(handle),
            wheelset_at(handle + size),
            wheelset_at(handle + 2 * size),
            wheelset_at(handle + 3 * size),
        )

    wheelsets_at = compile_inner(four_wheelsets)

    def begin_at(handle: int) -> int:
        begin(train_at(handle + train_place), wheelsets_at(handle), number_at(handle + speed_place).value)
        return 0

    def step_at(handle: int, inputs_address: int, outputs_address: int) -> int:
        inputs, outputs = inputs_at(inputs_address), outputs_at(outputs_address)
        train, wheelsets = train_at(handle + train_place), wheelsets_at(handle)
        for i in range(WHEELSETS):
            wheelsets[i].measured_speed = inputs.wheel_speed[i]
            wheelsets[i].speed_valid = inputs.speed_valid[i]
        give(train, wheelsets, inputs)
        decide(train, wheelsets, parameters_at(handle + parameters_place))
        for i in range(WHEELSETS):
            command = wheelsets[i].valve_command
            outputs.hold[i] = 0 if command == FILL else 1
            outputs.vent[i] = 1 if command == VENT else 0
        outputs.reference_speed = train.reference_speed
        answer(train, wheelsets, outputs)
        return 0

    return begin_at, step_at


def _nothing(train: Any, wheelsets: Any, memory: Any) -> None:
    """Version 1 has no more."""


def _give_version_2(train: Any, wheelsets: Any, inputs: Any) -> None:
    train.axle_load = inputs.axle_load
    train.brake_command = inputs.brake_command
    train.train_speed = inputs.train_speed
    train.train_speed_valid = inputs.train_speed_valid
    train.acceleration = inputs.acceleration
    train.acceleration_valid = inputs.acceleration_valid
    for i in range(WHEELSETS):
        wheelsets[i].dynamic_brake = inputs.dynamic_brake[i]


def _answer_version_2(train: Any, wheelsets: Any, outputs: Any) -> None:
    outputs.track_brake_request = train.track_brake_request
    for i in range(WHEELSETS):
        outputs.dynamic_reduction[i] = wheelsets[i].dynamic_reduction
        outputs.sand_request[i] = wheelsets[i].sand_request


_VERSIONS: Final = {1: (_nothing, _nothing), 2: (_give_version_2, _answer_version_2)}
"""What a controller of a contract version is given besides, and what it answers besides."""


def _translated(controller: Controller, compile_inner: Callable[[Any], Any]) -> tuple[Any, Any]:
    """Return the two functions of a controller compiled, with what they call of their package and of ours."""
    functions = controller.begin, controller.decide
    packages = {"uictest", *(function.__module__.partition(".")[0] for function in functions)}
    done: dict[Any, Any] = {fma: lanes.fma} if lanes.fuses() else {}
    begin, decide = (lanes.translate(function, compile_inner, done, packages) for function in functions)
    return begin, decide
