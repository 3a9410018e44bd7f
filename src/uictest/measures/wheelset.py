"""Measures of one wheelset: slide, locks, valve actuations, clamping force."""

from typing import Any

from uictest.measures.records import SPEED_CLASSES
from uictest.physics.arithmetic import maximum

Record = Any
NAN = float("nan")
_CLASSES_PER_SPEED = 3.6 / 10.0
"""Classes of 10 km/h per m/s."""


def begin_wheelset(measures: Record) -> None:
    """Start the measures of a wheelset that rolls with its brake released."""
    measures.maximum_slide = 0.0
    for k in range(SPEED_CLASSES):
        measures.maximum_slide_above[k] = NAN
    measures.first_sliding_time = NAN
    measures.sliding_duration = 0.0
    measures.locked_time = 0.0
    measures.longest_lock = 0.0
    measures.lock = 0.0
    measures.valve_actuations = 0.0
    measures.venting = 0.0
    measures.maximum_clamping_force = 0.0
    measures.air_vented = NAN


def observe_wheelset(
    measures: Record,
    train: Record,
    definition: Record,
    number: int,
    time: float,
    speed: float,
    wheel_speed: float,
    venting: float,
    clamping_force: float,
) -> None:
    """Take in the next sample of wheelset ``number`` (1..4), before the train's.

    Args:
        measures: record of :data:`~uictest.measures.records.WHEELSET_MEASURES`.
        train: record of :data:`~uictest.measures.records.MEASURES`; its last sample gives the interval.
        definition: record with the fields of :data:`~uictest.measures.records.DEFINITION`.
        number: number of the wheelset, from the leading end.
        time: since the brake command, s.
        speed: of the train, m/s.
        wheel_speed: circumferential speed r omega, m/s.
        venting: 1.0 while the WSP valve is commanded to vent, else 0.0.
        clamping_force: of one caliper, N.
    """
    if venting > measures.venting:
        measures.valve_actuations += 1.0
    measures.venting = venting
    measures.maximum_clamping_force = maximum(measures.maximum_clamping_force, clamping_force)
    if speed > definition.moving_speed:
        slip = speed - wheel_speed
        _observe_slide(measures, train, definition, number, time, speed, slip)
        _observe_lock(measures, definition, time - train.end_time, wheel_speed)


def _observe_slide(
    measures: Record, train: Record, definition: Record, number: int, time: float, speed: float, slip: float
) -> None:
    """Keep the largest slide, overall and for each lowest train speed, and the time spent sliding."""
    slide = slip / speed
    measures.maximum_slide = maximum(measures.maximum_slide, slide)
    for k in range(SPEED_CLASSES):
        if speed * _CLASSES_PER_SPEED > k and not measures.maximum_slide_above[k] >= slide:
            measures.maximum_slide_above[k] = slide
    if slide > definition.sliding_slide and slip > definition.sliding_slip:
        measures.sliding_duration += time - train.end_time
        if not measures.first_sliding_time <= time:
            measures.first_sliding_time = time
        if not train.sliding_time <= time:
            train.sliding_time = time
            train.sliding_wheelset = number


def _observe_lock(measures: Record, definition: Record, interval: float, wheel_speed: float) -> None:
    """Add up the time during which the wheelset stands while the train moves."""
    if wheel_speed < definition.locked_speed:
        measures.locked_time += interval
        measures.lock += interval
        measures.longest_lock = maximum(measures.longest_lock, measures.lock)
    else:
        measures.lock = 0.0
