"""Measures of the train: speed, distance, deceleration, air."""

from typing import Any

from uictest.measures.records import WINDOW_SECONDS
from uictest.physics.arithmetic import minimum

Record = Any
NAN = float("nan")


def begin(measures: Record, time: float, distance: float, speed: float, reservoir_pressure: float) -> None:
    """Start the measures with the first sample (s, m, m/s, Pa gauge)."""
    measures.initial_speed = speed
    measures.stopped = 0.0
    measures.braking_time = NAN
    measures.braking_distance = NAN
    measures.end_time = time
    measures.end_distance = distance
    measures.end_speed = speed
    measures.minimum_deceleration = NAN
    measures.maximum_deceleration = NAN
    measures.filtered_deceleration = 0.0
    measures.sliding_time = NAN
    measures.sliding_wheelset = NAN
    for second in range(WINDOW_SECONDS + 1):
        measures.speed_after_sliding[second] = NAN
    measures.reservoir_minimum_pressure = reservoir_pressure
    measures.air_consumed = NAN
    measures.energy_residual = NAN
    measures.air_residual = NAN
    measures.samples = 1.0


def observe_train(
    measures: Record,
    definition: Record,
    time: float,
    distance: float,
    speed: float,
    reservoir_pressure: float,
) -> None:
    """Take in the next sample, after the wheelsets' (s since the command, m, m/s, Pa gauge)."""
    _observe_deceleration(measures, definition, time, speed)
    _observe_window(measures, time, speed)
    measures.reservoir_minimum_pressure = minimum(measures.reservoir_minimum_pressure, reservoir_pressure)
    measures.end_time = time
    measures.end_distance = distance
    measures.end_speed = speed
    measures.samples += 1.0


def finish(measures: Record, time: float, distance: float) -> None:
    """Note that the train came to a standstill at ``time`` s after ``distance`` m."""
    measures.stopped = 1.0
    measures.braking_time = time
    measures.braking_distance = distance
    measures.end_time = time
    measures.end_distance = distance
    measures.end_speed = 0.0


def _observe_deceleration(measures: Record, definition: Record, time: float, speed: float) -> None:
    """Filter the deceleration and keep its extremes while the train moves and the brake is developed."""
    interval = time - measures.end_time
    deceleration = (measures.end_speed - speed) / interval
    share = interval / (interval + definition.deceleration_filter)
    filtered = measures.filtered_deceleration + share * (deceleration - measures.filtered_deceleration)
    measures.filtered_deceleration = filtered
    if speed < definition.moving_speed:
        return
    # Until the first sample the extremes are NaN, and every comparison with NaN is false.
    if not measures.maximum_deceleration >= filtered:
        measures.maximum_deceleration = filtered
    if time >= definition.developed_time and not measures.minimum_deceleration <= filtered:
        measures.minimum_deceleration = filtered


def _observe_window(measures: Record, time: float, speed: float) -> None:
    """Keep the speed at whole seconds after the first sliding, linear between samples."""
    since = time - measures.sliding_time
    if not since >= 0.0:
        return
    before = measures.end_time - measures.sliding_time
    second = int(before) if before >= 0.0 else -1
    while second < WINDOW_SECONDS and second + 1.0 <= since:
        second += 1
        share = (second - before) / (since - before)
        measures.speed_after_sliding[second] = measures.end_speed + share * (speed - measures.end_speed)
