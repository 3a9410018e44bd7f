"""The choice of the controller in the model, and a controller from outside in it.

For a controller from outside the rig writes inputs, calls and reads the answer. Inputs and
outputs lie in memory of their own, :data:`uictest.controllers.EXCHANGE`; the kernel has functions of
its own for those that reach memory by its address.
"""

import ctypes
from collections.abc import Sequence
from typing import Any, Final

import numpy as np

from uictest.controllers import (
    CONTROLLERS,
    DAMAGED,
    EXCHANGE,
    FORBIDDEN_COMMAND,
    GUARD,
    NO_FAILURE,
    NO_MAGNET_STATE,
    NO_REDUCTION,
    NO_REFERENCE,
    NO_REQUEST,
    NOT_CALLED,
    OUTPUTS_AT,
    STEP_FAILED,
    STEPPING,
    UNTOUCHED,
    WROTE_BEYOND,
    ControlledWheelset,
    Controller,
    ControllerCycle,
    TrainMemory,
)
from uictest.core.physics import FILL, HOLD, VENT
from uictest.rig.kernel.arguments import at
from uictest.rig.kernel.library import Entry
from uictest.rig.model.parameters import PARAMETERS, Parameters
from uictest.rig.model.state import CAR, WHEELSET, Car, Wheelset

_NAN = float("nan")
_INFINITE = float("inf")


def begin_external(train: TrainMemory, wheelsets: Sequence[ControlledWheelset], speed: float) -> None:
    """Start without an estimate of the train's speed."""
    train.reference_speed = _NAN


def decide_external(car: Car, wheelsets: Sequence[Wheelset], p: Parameters) -> None:
    """Call the controller; its failure ends the stop."""
    exchange = exchange_at(p.controller_exchange)
    if exchange.failure != NO_FAILURE:  # not of this controller: its own would have ended the stop
        exchange.failure = DAMAGED
        car.controller_failed = 1
        return
    write_inputs(exchange, car, wheelsets, p)
    exchange.calling = STEPPING
    exchange.cycles += 1
    status = call_step(p.controller_step, p.controller_handle, p.controller_exchange)
    exchange.calling = NOT_CALLED
    if exchange.failure != NO_FAILURE:
        exchange.failure = WROTE_BEYOND
    elif status != 0:
        exchange.failure = STEP_FAILED
    else:
        read_outputs(exchange, car, wheelsets, p)
    car.controller_failed = 1 if exchange.failure != NO_FAILURE else 0


def decide_watched(j: int, cars: Sequence[Car], wheelsets: Sequence[Wheelset], parameters: Any) -> None:
    """Let the controller of car ``j`` decide; if what is noted on another changes meanwhile, it has failed.

    The notes on all of them lie in the memory of one process, where any may write.
    """
    intact = parameters[j].controller == FROM_OUTSIDE and _others_intact(j, cars, parameters)
    decide(cars[j], wheelsets, parameters[j])
    if intact and not _others_intact(j, cars, parameters):
        exchange_at(parameters[j].controller_exchange).failure = WROTE_BEYOND
        cars[j].controller_failed = 1


def _others_intact(j: int, cars: Sequence[Car], parameters: Sequence[Parameters]) -> bool:
    """Whether what is noted on the others from outside is as the rig left it, those that failed aside."""
    intact = True
    for k in range(len(cars)):
        if k != j and parameters[k].controller == FROM_OUTSIDE and cars[k].controller_failed == 0:
            notes = exchange_at(parameters[k].controller_exchange)
            intact = intact and notes.failure == NO_FAILURE and notes.failed_wheelset == 0
            intact = intact and notes.calling == NOT_CALLED and notes.cycles == cars[k].cycle
            intact = intact and (notes.cycles == 0 or notes.guard == GUARD)
    return intact


def write_inputs(exchange: Any, car: Car, wheelsets: Sequence[Wheelset], p: Parameters) -> None:
    """Write what the sensors show, and outputs that fill every tank."""
    exchange.cycle = car.cycle
    exchange.time = car.cycle * p.cycle_time
    exchange.brake_demand = car.command_pressure * p.demand_per_pressure
    exchange.reference_speed = _NAN
    exchange.diagnosis = 0
    exchange.axle_load = car.axle_load
    exchange.brake_command = car.brake_command
    exchange.train_speed = car.train_speed
    exchange.train_speed_valid = car.train_speed_valid
    exchange.acceleration = car.acceleration
    exchange.acceleration_valid = car.acceleration_valid
    exchange.track_brake_request = 0
    exchange.guard = GUARD
    for i in range(4):
        exchange.wheel_speed[i] = wheelsets[i].measured_speed
        pressure = wheelsets[i].pressure_reading
        exchange.cylinder_pressure[i] = wheelsets[i].shown_pressure if p.fault_count > 0 else pressure
        exchange.speed_valid[i] = wheelsets[i].speed_valid
        exchange.dynamic_brake[i] = wheelsets[i].dynamic_brake
        exchange.hold[i] = 0
        exchange.vent[i] = 0
        exchange.dynamic_reduction[i] = 0.0 if p.controller_contract > 1 else UNTOUCHED
        exchange.sand_request[i] = 0


def read_outputs(exchange: Any, car: Car, wheelsets: Sequence[Wheelset], p: Parameters) -> None:
    """Set what the controller commands and requests; a command that no valve has is a failure."""
    if exchange.guard != GUARD or (p.controller_contract == 1 and _was_touched(exchange)):
        exchange.failure = WROTE_BEYOND
    if abs(exchange.reference_speed) == _INFINITE and exchange.failure == NO_FAILURE:
        exchange.failure = NO_REFERENCE
    car.reference_speed = exchange.reference_speed
    car.diagnosis = exchange.diagnosis
    for i in range(4):
        hold = exchange.hold[i]
        vent = exchange.vent[i]
        problem = _problem(hold, vent)
        if problem != NO_FAILURE and exchange.failure == NO_FAILURE:
            exchange.failure = problem
            exchange.failed_wheelset = i
        wheelsets[i].valve_command = VENT if vent == 1 else (HOLD if hold == 1 else FILL)
    if p.controller_contract > 1:
        _read_version_2(exchange, car, wheelsets)


def _was_touched(exchange: Any) -> bool:
    """Whether a controller of version 1 has written where the outputs of version 2 go on."""
    touched = bool(exchange.track_brake_request != 0)
    for i in range(4):
        touched = touched or exchange.dynamic_reduction[i] != UNTOUCHED or exchange.sand_request[i] != 0
    return touched


def _read_version_2(exchange: Any, car: Car, wheelsets: Sequence[Wheelset]) -> None:
    for i in range(4):
        reduction = exchange.dynamic_reduction[i]
        sand = exchange.sand_request[i]
        problem = NO_FAILURE if 0.0 <= reduction <= 1.0 else NO_REDUCTION  # not a number: no reduction
        if sand < 0 or sand > 1:
            problem = NO_REQUEST
        if problem != NO_FAILURE and exchange.failure == NO_FAILURE:
            exchange.failure = problem
            exchange.failed_wheelset = i
        wheelsets[i].dynamic_reduction = reduction
        wheelsets[i].sand_request = sand
    request = exchange.track_brake_request
    if (request < 0 or request > 1) and exchange.failure == NO_FAILURE:
        exchange.failure = NO_REQUEST
    car.track_brake_request = request


def _problem(hold: int, vent: int) -> int:
    if hold < 0 or hold > 1 or vent < 0 or vent > 1:
        return NO_MAGNET_STATE
    return FORBIDDEN_COMMAND if vent > hold else NO_FAILURE


def exchange_at(address: int) -> Any:
    """Return the exchange that lies at an address."""
    memory: Any = (ctypes.c_char * EXCHANGE.itemsize).from_address(address)
    return np.frombuffer(memory, EXCHANGE).view(np.recarray)[0]


def call_step(step: int, handle: int, exchange: int) -> int:
    """Call a controller's step by its address and return its status."""
    function = ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p)(step)
    status: int = function(handle, exchange, exchange + OUTPUTS_AT)
    return status


EXTERNAL = Controller(
    name="external",
    parameters=ControllerCycle,
    train_memory=TrainMemory,
    wheelset_memory=ControlledWheelset,
    begin=begin_external,
    decide=decide_external,
)
"""Stands for every controller from outside."""

CHOICES: tuple[Controller, ...] = (EXTERNAL, *CONTROLLERS.values())
"""What may stand in that place; a case names one by its number here, ``Parameters.controller``."""
FROM_OUTSIDE: Final = CHOICES.index(EXTERNAL)
"""Number of what stands for every controller from outside."""


def begin(train: TrainMemory, wheelsets: Sequence[ControlledWheelset], p: Parameters) -> None:
    """Set the memory of the case's controller at the start of a stop."""
    CHOICES[p.controller].begin(train, wheelsets, p.initial_speed)


def decide(train: TrainMemory, wheelsets: Sequence[ControlledWheelset], p: Parameters) -> None:
    """Let the case's controller set the valve commands of the coming cycle."""
    CHOICES[p.controller].decide(train, wheelsets, p)


CONTROLLER_MEMORY: Final[Any] = np.dtype(
    [("car", CAR), ("wheelsets", WHEELSET, 4), ("parameters", PARAMETERS), ("exchange", EXCHANGE)]
)
"""What a controller remembers, in the records of the rig, and what it is given and answers."""
ALONE: Final = Entry(
    "uictest.rig.model.controller:decide_alone", (at(CAR), at(WHEELSET, 4), at(PARAMETERS), at(EXCHANGE))
)


def decide_alone(car: Car, wheelsets: Sequence[Wheelset], p: Parameters, exchange: Any) -> None:
    """Let the controller that the parameters name answer the inputs of a cycle; the first begins a stop."""
    if exchange.cycle == 0:
        begin(car, wheelsets, p)
    car.axle_load = exchange.axle_load
    car.brake_command = exchange.brake_command
    car.train_speed = exchange.train_speed
    car.train_speed_valid = exchange.train_speed_valid
    car.acceleration = exchange.acceleration
    car.acceleration_valid = exchange.acceleration_valid
    for i in range(4):
        wheelsets[i].measured_speed = exchange.wheel_speed[i]
        wheelsets[i].speed_valid = exchange.speed_valid[i]
        wheelsets[i].dynamic_brake = exchange.dynamic_brake[i]
    decide(car, wheelsets, p)
    exchange.reference_speed = car.reference_speed
    exchange.track_brake_request = car.track_brake_request
    for i in range(4):
        command = wheelsets[i].valve_command
        exchange.hold[i] = 0 if command == FILL else 1
        exchange.vent[i] = 1 if command == VENT else 0
        exchange.dynamic_reduction[i] = wheelsets[i].dynamic_reduction
        exchange.sand_request[i] = wheelsets[i].sand_request
