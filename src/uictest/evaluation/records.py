"""What judging needs of a stop: the fields of the measures, read by attribute.

The rig fills records with these fields while it steps, `evaluate` from a recording; either way the values are
SI, and NaN where the stop never reached what a field measures.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Protocol

from uictest.units import KILOMETRE_PER_HOUR

SLIDE_CLASS = 10.0 * KILOMETRE_PER_HOUR
"""m/s: `maximum_slide_above[k]` counts while the train runs faster than k of these (10 km/h each)."""

SECONDS_AFTER_SLIDING = 11
"""Length of `speed_after_sliding`: the train speed 0, 1, ... 10 s after the first sliding."""


class StopMeasures(Protocol):
    """The measures of one stop that judging reads. SI units; pressures gauge."""

    initial_speed: float
    stopped: float
    braking_time: float
    braking_distance: float
    end_speed: float
    end_time: float
    end_distance: float
    minimum_deceleration: float
    maximum_deceleration: float
    sliding_time: float
    speed_after_sliding: Sequence[float]
    reservoir_minimum_pressure: float
    air_consumed: float
    energy_residual: float
    air_residual: float


class WheelsetMeasures(Protocol):
    """The measures of one wheelset that judging reads. SI units; slides are shares."""

    maximum_slide: float
    maximum_slide_above: Sequence[float]
    sliding_duration: float
    locked_time: float
    longest_lock: float
    valve_actuations: float
    maximum_clamping_force: float
    air_vented: float


Wheelsets = Iterable[WheelsetMeasures]
"""One record per wheelset, from the leading end; may be iterated more than once."""
