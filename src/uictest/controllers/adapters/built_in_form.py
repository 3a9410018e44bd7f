"""Controllers in the built-in form, compiled to a function that the rig calls by address."""

from collections.abc import Callable, Mapping
from functools import cache
from importlib import import_module
from typing import Any, Final, NamedTuple

import numpy as np

from uictest.controllers.adapters.declared_values import parameter_values
from uictest.controllers.adapters.instance import ControllerError, reason_of
from uictest.controllers.contract import Controller
from uictest.controllers.exchange import INPUTS, OUTPUTS, WHEELSETS
from uictest.controllers.interface import Config
from uictest.core import lanes
from uictest.core.physics import FILL, VENT, fma
from uictest.core.record import layout_of

_OPTIONS: Final = {"error_model": "numpy", "nogil": True}
"""As the rig is compiled: the same source gives the same bits."""


class CompiledInstance:
    """The memory of a controller, and the compiled functions that work on it."""

    runs_beside_others = True
    response_times = None

    def __init__(
        self, controller: Controller, parameters: Mapping[str, Any], config: Config, version: str
    ) -> None:
        self.version = version
        self._memory: Any = np.zeros(1, _memory_of(controller))
        values = parameter_values(controller, parameters, config.cycle_time)
        for name, value in values.items():
            self._memory["parameters"][name] = value
        self._memory["initial_speed"] = config.initial_speed
        try:
            self._functions = _compiled(controller)
        except Exception as error:
            raise ControllerError(f"{controller.name} cannot be compiled: {reason_of(error)}") from error

    @property
    def step_address(self) -> int:
        """Address of the compiled step."""
        return int(self._functions.step.address)

    @property
    def handle(self) -> int:
        """Address of the memory."""
        return int(self._memory.__array_interface__["data"][0])

    def reset(self) -> None:
        """Begin a stop."""
        for name in ("train", "wheelsets"):
            self._memory[name] = np.zeros(1, self._memory.dtype)[name]
        self._functions.begin.ctypes(self.handle)

    def last_error(self) -> str:
        """Return nothing: compiled code raises nothing."""
        return ""

    def close(self) -> None:
        """Release nothing: the functions stay for the next stop."""


class _Functions(NamedTuple):
    begin: Any
    step: Any


def _memory_of(controller: Controller) -> Any:
    """Return the layout of what a controller remembers and is given."""
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
    memory = _memory_of(controller)
    train_place, parameters_place, speed_place = (
        memory.fields[name][1] for name in ("train", "parameters", "initial_speed")
    )
    size = layout_of(controller.wheelset_memory).itemsize
    train_at = lanes.record_at(memory["train"])
    wheelset_at = lanes.record_at(layout_of(controller.wheelset_memory))
    parameters_at = lanes.record_at(memory["parameters"])
    number_at = lanes.record_at(np.dtype([("value", "f8")]))
    inputs_at, outputs_at = lanes.record_at(INPUTS), lanes.record_at(OUTPUTS)
    begin, decide = _translated(controller)

    def four_wheelsets(handle: int) -> Any:
        return (
            wheelset_at(handle),
            wheelset_at(handle + size),
            wheelset_at(handle + 2 * size),
            wheelset_at(handle + 3 * size),
        )

    wheelsets_at = _compile_inner(four_wheelsets)

    def begin_at(handle: int) -> int:
        begin(train_at(handle + train_place), wheelsets_at(handle), number_at(handle + speed_place).value)
        return 0

    def step_at(handle: int, inputs_address: int, outputs_address: int) -> int:
        inputs, outputs = inputs_at(inputs_address), outputs_at(outputs_address)
        train, wheelsets = train_at(handle + train_place), wheelsets_at(handle)
        for i in range(WHEELSETS):
            wheelsets[i].measured_speed = inputs.wheel_speed[i]
            wheelsets[i].speed_valid = inputs.speed_valid[i]
        decide(train, wheelsets, parameters_at(handle + parameters_place))
        for i in range(WHEELSETS):
            command = wheelsets[i].valve_command
            outputs.hold[i] = 0 if command == FILL else 1
            outputs.vent[i] = 1 if command == VENT else 0
        outputs.reference_speed = train.reference_speed
        return 0

    address, status = numba.int64, numba.int32
    return _Functions(
        numba.cfunc(status(address), **_OPTIONS)(begin_at),
        numba.cfunc(status(address, address, address), **_OPTIONS)(step_at),
    )


def _compile_inner(function: Callable[..., Any]) -> Any:
    return lanes.compile_inner(function, **_OPTIONS)


def _translated(controller: Controller) -> tuple[Any, Any]:
    """Return the two functions of a controller compiled, with what they call of their package and of ours."""
    functions = controller.begin, controller.decide
    packages = {"uictest", *(function.__module__.partition(".")[0] for function in functions)}
    done: dict[Any, Any] = {fma: lanes.fma} if lanes.fuses() else {}
    begin, decide = (lanes.translate(function, _compile_inner, done, packages) for function in functions)
    return begin, decide
