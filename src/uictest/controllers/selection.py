"""Which controller decides."""

from uictest.controllers import slip_band, threshold
from uictest.controllers.contract import Car, Parameters, Wheelsets
from uictest.controllers.slip_band import begin as begin_slip_band, decide as decide_by_slip_band
from uictest.controllers.threshold import begin as begin_threshold, decide as decide_by_threshold

ALGORITHMS = ("threshold", "slip-band")
"""Names of the controllers; a controller's place here is its number in the records."""

CAR_MEMORY = threshold.CAR_MEMORY + slip_band.CAR_MEMORY
"""Fields that the controllers keep in the car record."""
WHEELSET_MEMORY = threshold.WHEELSET_MEMORY + slip_band.WHEELSET_MEMORY
"""Fields that the controllers keep in the wheelset record."""


def begin(car: Car, wheelsets: Wheelsets, speed: float) -> None:
    """Set the memory of every controller at the start of a stop from ``speed`` m/s."""
    begin_threshold(car, wheelsets, speed)
    begin_slip_band(car, wheelsets, speed)


def decide(car: Car, wheelsets: Wheelsets, parameters: Parameters) -> None:
    """Let the controller of this case set the valve commands of the coming cycle."""
    if parameters.algorithm == 1:
        decide_by_slip_band(car, wheelsets, parameters)
    else:
        decide_by_threshold(car, wheelsets, parameters)


def reference_speed(car: Car, parameters: Parameters) -> float:
    """Estimate of the train's speed by the controller of this case, m/s."""
    return float(car.band_reference_speed if parameters.algorithm == 1 else car.reference_speed)
