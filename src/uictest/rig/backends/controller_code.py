"""A built-in controller alone, in machine code, for a library that other programs load."""

from typing import Any, Final, NamedTuple

import numpy as np

from uictest.controllers import INPUTS, OUTPUTS, Controller
from uictest.core import lanes
from uictest.core.physics import FILL, VENT
from uictest.core.record import layout_of
from uictest.rig.backends.compiled import compile_inner, compiled_operations
from uictest.rig.backends.machine_code import Entry, Target, Unit, object_code

_WHEELSETS: Final[int] = INPUTS["wheel_speed"].shape[0]


class ControllerCode(NamedTuple):
    """An object file, and the name of its function: of the addresses of memory, inputs and outputs.

    The memory is that of :func:`controller_memory`. Without inputs, the function begins a stop.
    """

    function: str
    content: bytes


def controller_code(controller: Controller, target: Target) -> ControllerCode:
    """Return a controller of this package as an object file for a target."""
    name = f"uictest_{controller.name.replace('-', '_')}"
    entry = Entry(name, f"the controller {controller.name}", (int, int, int))
    unit = Unit(f"{name}_controller", (entry,), lambda: [_begin_or_decide(controller)])
    return ControllerCode(name, object_code(unit, entry, target))


def controller_memory(controller: Controller) -> Any:
    """Return the layout of what a controller remembers, and behind it of what it is given."""
    return np.dtype(
        [
            ("wheelsets", layout_of(controller.wheelset_memory), _WHEELSETS),
            ("train", layout_of(controller.train_memory)),
            ("parameters", layout_of(controller.parameters)),
            ("initial_speed", "f8"),
        ]
    )


def _begin_or_decide(controller: Controller) -> Any:
    """Return what begins a stop where the address of the inputs is 0, and else decides on a cycle."""
    memory = controller_memory(controller)
    train_place, parameters_place, speed_place = (
        memory.fields[name][1] for name in ("train", "parameters", "initial_speed")
    )
    size = layout_of(controller.wheelset_memory).itemsize
    train_at = lanes.record_at(memory["train"])
    wheelset_at = lanes.record_at(layout_of(controller.wheelset_memory))
    parameters_at = lanes.record_at(memory["parameters"])
    number_at = lanes.record_at(np.dtype([("value", "f8")]))
    inputs_at, outputs_at = lanes.record_at(INPUTS), lanes.record_at(OUTPUTS)
    operations = compiled_operations()
    begin, decide = (
        lanes.translate(each, compile_inner, operations) for each in (controller.begin, controller.decide)
    )
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

    def decide_at(handle: int, inputs_address: int, outputs_address: int) -> int:
        inputs, outputs = inputs_at(inputs_address), outputs_at(outputs_address)
        train, wheelsets = train_at(handle + train_place), wheelsets_at(handle)
        for i in range(_WHEELSETS):
            wheelsets[i].measured_speed = inputs.wheel_speed[i]
            wheelsets[i].speed_valid = inputs.speed_valid[i]
        give(train, wheelsets, inputs)
        decide(train, wheelsets, parameters_at(handle + parameters_place))
        for i in range(_WHEELSETS):
            command = wheelsets[i].valve_command
            outputs.hold[i] = 0 if command == FILL else 1
            outputs.vent[i] = 1 if command == VENT else 0
        outputs.reference_speed = train.reference_speed
        answer(train, wheelsets, outputs)
        return 0

    beginning, deciding = compile_inner(begin_at), compile_inner(decide_at)

    def begin_or_decide(handle: int, inputs: int, outputs: int) -> Any:
        return beginning(handle) if inputs == 0 else deciding(handle, inputs, outputs)

    return compile_inner(begin_or_decide)


def _nothing(train: Any, wheelsets: Any, memory: Any) -> None:
    """Version 1 has no more."""


def _give_version_2(train: Any, wheelsets: Any, inputs: Any) -> None:
    train.axle_load = inputs.axle_load
    train.brake_command = inputs.brake_command
    train.train_speed = inputs.train_speed
    train.train_speed_valid = inputs.train_speed_valid
    train.acceleration = inputs.acceleration
    train.acceleration_valid = inputs.acceleration_valid
    for i in range(_WHEELSETS):
        wheelsets[i].dynamic_brake = inputs.dynamic_brake[i]


def _answer_version_2(train: Any, wheelsets: Any, outputs: Any) -> None:
    outputs.track_brake_request = train.track_brake_request
    for i in range(_WHEELSETS):
        outputs.dynamic_reduction[i] = wheelsets[i].dynamic_reduction
        outputs.sand_request[i] = wheelsets[i].sand_request


_VERSIONS: Final = {1: (_nothing, _nothing), 2: (_give_version_2, _answer_version_2)}
"""What a controller of a contract version is given besides, and what it answers besides."""
