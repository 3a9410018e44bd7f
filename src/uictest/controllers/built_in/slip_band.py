"""Slip-band controller: fill below a lower slide, vent above an upper one, hold between them.

The simplest controller that protects a wheelset: two thresholds of relative slide against the fastest
wheelset, whose estimate may fall at a bounded rate. On a rail so slippery that all wheelsets slide
together its reference sinks with them.
"""

from collections.abc import Iterator, Sequence

from uictest.controllers.contract import (
    Conflict,
    ControlledWheelset,
    Controller,
    ControllerParameters,
    TrainMemory,
    share,
)
from uictest.core.physics import FILL, HOLD, VENT, maximum


class Parameters(ControllerParameters):
    """Fill below a lower slide, vent above an upper one, hold between them."""

    lower_slide: float = share("Slide below which the tank is filled.")
    upper_slide: float = share("Slide above which the tank is vented.")


def conflicts(parameters: Parameters) -> Iterator[Conflict]:
    """Yield a band that is upside down."""
    if parameters.lower_slide >= parameters.upper_slide:
        yield Conflict("lower_slide", "it must be below upper_slide")


def begin(train: TrainMemory, wheelsets: Sequence[ControlledWheelset], speed: float) -> None:
    """Start from rolling at ``speed`` m/s."""
    train.reference_speed = speed


def decide(train: TrainMemory, wheelsets: Sequence[ControlledWheelset], parameters: Parameters) -> None:
    """Set the command of each wheelset; see the contract in :mod:`uictest.controllers`."""
    reference = train.reference_speed - parameters.reference_deceleration * parameters.cycle_time
    for i in range(4):
        reference = maximum(reference, wheelsets[i].measured_speed)
    train.reference_speed = reference
    for i in range(4):
        slide = (reference - wheelsets[i].measured_speed) / maximum(reference, parameters.minimum_speed)
        if reference < parameters.minimum_speed or slide < parameters.lower_slide:
            wheelsets[i].valve_command = FILL
        else:
            wheelsets[i].valve_command = VENT if slide > parameters.upper_slide else HOLD


CONTROLLER = Controller(
    name="slip-band",
    parameters=Parameters,
    train_memory=TrainMemory,
    wheelset_memory=ControlledWheelset,
    begin=begin,
    decide=decide,
    conflicts=conflicts,
)
