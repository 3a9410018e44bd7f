"""Braking distance, braking time and mean deceleration of a stop."""

from __future__ import annotations

import math

from uictest.evaluation.measure_value import MeasureValue, unsupported, value
from uictest.evaluation.records import StopMeasures


def braking_distance(measures: StopMeasures) -> MeasureValue:
    """Return the distance (m) from the brake command to standstill or, before standstill, up to now.

    The distance is not corrected for the initial speed.
    """
    return value(measures.braking_distance if measures.stopped else measures.end_distance)


def braking_time(measures: StopMeasures) -> MeasureValue:
    """Return the time (s) from the brake command to standstill or, before standstill, up to now."""
    return value(measures.braking_time if measures.stopped else measures.end_time)


def mean_deceleration(measures: StopMeasures) -> MeasureValue:
    """Return v0^2 / (2 s) in m/s2, s the braking distance (up to now) from the initial speed v0."""
    (distance,) = braking_distance(measures).values
    return value(measures.initial_speed**2 / (2.0 * distance) if distance else math.inf)


def standstill(measures: StopMeasures) -> MeasureValue:
    """Return 1 where the train came to a standstill."""
    return value(1.0) if measures.stopped else unsupported("no standstill")
