"""What is calibrated: free parameters, their bounds and the record fields that they set."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Fields = dict[str, float]


@dataclass(frozen=True)
class Free:
    """A free parameter: where it stands, in the unit of the record, between which bounds."""

    name: str
    low: float
    high: float
    logarithmic: bool = False

    def value(self, share: float) -> float:
        """Value at a share 0..1 of the way from the lower to the upper bound."""
        if self.logarithmic:
            return self.low * (self.high / self.low) ** share
        return self.low + share * (self.high - self.low)

    def share(self, value: float) -> float:
        """Where a value lies between the bounds, 0..1."""
        if self.logarithmic:
            return math.log(value / self.low) / math.log(self.high / self.low)
        return (value - self.low) / (self.high - self.low)


FREE = (
    Free("vent_conductance", 2.6e-8, 3.2e-8, logarithmic=True),
    Free("fill_conductance", 5.5e-8, 7.5e-8, logarithmic=True),
    Free("switching_delay", 0.010, 0.080),
    Free("slip_threshold", 0.3, 2.5),
    Free("slide_threshold", 0.0, 0.06),
    Free("vent_deceleration", 1.5, 12.0),
    Free("hold_deceleration", 0.0, 4.0),
    Free("reacceleration_threshold", 0.1, 1.5),
    Free("acceleration_filter_time", 0.03, 0.08),
    Free("recovery_share", 0.2, 1.0),
    Free("fill_pulse_on", 0.02, 0.15),
    Free("fill_pulse_off", 0.02, 0.15),
    Free("refill_time", 0.1, 1.2),
    Free("commanded_pressure", 4.2e5, 4.8e5),  # emergency application, gauge
    Free("friction", 0.155, 0.168),  # of the rail in the slide test
)


def values(shares: NDArray[np.float64]) -> Fields:
    """Free parameters by name."""
    return {free.name: free.value(share) for free, share in zip(FREE, shares, strict=True)}


def fields(chosen: Fields, base: Any) -> Fields:
    """Record fields for a choice of free parameters; the friction of the rail is not one of them."""
    record = dict(chosen)
    record.pop("friction")
    delay = round(record.pop("switching_delay") / float(base.step))
    record["valve_delay_cycles"], record["valve_delay_steps"] = divmod(delay, int(base.steps_per_cycle))
    return record
