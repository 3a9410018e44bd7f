"""A built-in controller without a rig: the code of what a tool calls that has exported one."""

from collections.abc import Sequence
from typing import Any, Final

import numpy as np

from uictest.controllers import EXCHANGE
from uictest.core.physics import FILL, VENT
from uictest.rig.kernel.arguments import at
from uictest.rig.kernel.library import Entry
from uictest.rig.model.controller import begin, decide
from uictest.rig.model.parameters import PARAMETERS, Parameters
from uictest.rig.model.state import CAR, WHEELSET, Car, Wheelset

CONTROLLER_MEMORY: Final[Any] = np.dtype(
    [("car", CAR), ("wheelsets", WHEELSET, 4), ("parameters", PARAMETERS), ("exchange", EXCHANGE)]
)
"""What a controller remembers, in the records of the rig, and what it is given and answers."""
ALONE: Final = Entry(
    "uictest.rig.controller_alone:decide_alone", (at(CAR), at(WHEELSET, 4), at(PARAMETERS), at(EXCHANGE))
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
