"""Slip-band controller: fill below a lower slide, vent above an upper one, hold between them.

The simplest controller that protects a wheelset: two thresholds of relative slide against the fastest
wheelset, whose estimate may fall at a bounded rate. On a rail so slippery that all wheelsets slide
together its reference sinks with them.
"""

from uictest.controllers.contract import Car, Parameters, Wheelsets
from uictest.physics import FILL, HOLD, VENT, maximum

CAR_MEMORY = (("band_reference_speed", "f8"),)
WHEELSET_MEMORY: tuple[tuple[str, str], ...] = ()


def begin(car: Car, wheelsets: Wheelsets, speed: float) -> None:
    """Start from rolling at ``speed`` m/s."""
    car.band_reference_speed = speed


def decide(car: Car, wheelsets: Wheelsets, parameters: Parameters) -> None:
    """Set the command of each wheelset; see the contract in :mod:`uictest.controllers`."""
    reference = car.band_reference_speed - parameters.band_reference_deceleration * parameters.cycle_time
    for i in range(4):
        reference = maximum(reference, wheelsets[i].measured_speed)
    car.band_reference_speed = reference
    for i in range(4):
        slide = (reference - wheelsets[i].measured_speed) / maximum(reference, parameters.band_minimum_speed)
        wheelsets[i].command = _command(slide, reference, parameters)


def _command(slide: float, reference: float, parameters: Parameters) -> int:
    """Valve command for a relative slide; the protection rests below the lowest speed."""
    if reference < parameters.band_minimum_speed or slide < parameters.lower_slide:
        return FILL
    return VENT if slide > parameters.upper_slide else HOLD
