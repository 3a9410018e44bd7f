"""Braking distance, braking time and mean deceleration of a stop."""

from __future__ import annotations

from uictest.evaluation.reading import Reading, unsupported, value
from uictest.evaluation.records import StopMeasures
from uictest.evaluation.units import text


def braking_distance(measures: StopMeasures) -> Reading:
    """Return the distance (m) from the brake command to standstill, not corrected for the initial speed."""
    if measures.stopped:
        return value(measures.braking_distance)
    return Reading((float(measures.end_distance),), _still_running(measures), at_least=True)


def braking_time(measures: StopMeasures) -> Reading:
    """Return the time (s) from the brake command to standstill."""
    if measures.stopped:
        return value(measures.braking_time)
    return Reading((float(measures.end_time),), _still_running(measures), at_least=True)


def mean_deceleration(measures: StopMeasures) -> Reading:
    """Return v0^2 / (2 s) in m/s2, s the braking distance from the initial speed v0."""
    if not measures.stopped:
        return unsupported(_still_running(measures))
    return value(measures.initial_speed**2 / (2.0 * measures.braking_distance))


def standstill(measures: StopMeasures) -> Reading:
    """Return 1 where the train came to a standstill, 0 where the record ended before."""
    return value(1.0) if measures.stopped else Reading((0.0,), remark=_still_running(measures))


def _still_running(measures: StopMeasures) -> str:
    speed, time = text(measures.end_speed * 3.6, "km/h"), text(measures.end_time, "s")
    return f"the train still ran at {speed} when the record ended after {time}"
