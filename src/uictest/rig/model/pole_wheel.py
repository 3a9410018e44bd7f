"""Speed sensors that count whole teeth, or whose pole wheel is eccentric or has lost teeth.

Once per controller cycle and in lanes, only in stops where a wheelset has such a sensor.
"""

import math
from collections.abc import Sequence

from uictest.core.physics import (
    last_tooth,
    passed_turns,
    passing_rate,
    select,
    speed_of_teeth,
    time_since,
    uniform,
)
from uictest.rig.model.cycle import CHANNELS, SPEED, noise_words, sensor_noise
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.state import Car, Wheelset

_PHASE = 3
"""Noise channel of a wheelset that gives the angle of its pole wheel at the brake command."""
_PER_RADIAN = 0.5 / math.pi
"""Turns."""


def read_pole_wheels(car: Car, wheelsets: Sequence[Wheelset], p: Parameters) -> None:
    """Put in the place of all momentary speeds what the pole wheels show, for cycle ``car.cycle``."""
    read_pole_wheel(wheelsets[0], car, p, 0)
    read_pole_wheel(wheelsets[1], car, p, 1)
    read_pole_wheel(wheelsets[2], car, p, 2)
    read_pole_wheel(wheelsets[3], car, p, 3)


def read_pole_wheel(wheelset: Wheelset, car: Car, p: Parameters, number: int) -> None:
    """Read the pole wheel of one wheelset after its momentary speed has been read."""
    turns = wheelset.angle * _PER_RADIAN + uniform(noise_words(p, 0, number * CHANNELS + _PHASE))
    rate = passing_rate(turns, wheelset.eccentricity)
    momentary = wheelset.measured_speed * rate
    _count(wheelset, car, p, turns, rate)
    held = wheelset.tooth_speed
    age = car.time - wheelset.tooth_time
    slowest = wheelset.slowest_measured_speed
    silent = select(held < slowest, 1.0, select(age * slowest > wheelset.tooth_pitch, 1.0, 0.0))
    noise = wheelset.speed_noise * sensor_noise(p, car.cycle, number * CHANNELS + SPEED)
    averaged = select(silent > 0.0, 0.0, held * (1.0 + (noise + wheelset.speed_gain_error)))
    wheelset.measured_speed = select(wheelset.counts_teeth > 0.0, averaged, momentary)


def _count(wheelset: Wheelset, car: Car, p: Parameters, turns: float, rate: float) -> None:
    """Take the speed of the whole teeth that have passed since the last one before; none: keep the speed.

    Args:
        turns: of the pole wheel.
        rate: at which it passes the sensor at present, over that of its rotation.
    """
    begins = car.cycle == 0
    tooth_rate = wheelset.rotation * _PER_RADIAN * wheelset.teeth * rate
    configured_speed = wheelset.rotation * wheelset.configured_radius * rate
    place = passed_turns(turns, wheelset.eccentricity) * wheelset.teeth
    counted, tooth = last_tooth(place, wheelset.teeth, wheelset.missing_teeth)
    rate_before = select(begins, tooth_rate, wheelset.tooth_rate)
    time = car.time - time_since(place - tooth, tooth_rate, rate_before, p.cycle_time)
    # By the teeth that the wheel has now: it may have lost some since.
    before, _ = last_tooth(wheelset.last_tooth, wheelset.teeth, wheelset.missing_teeth)
    passed = counted - select(begins, counted, before)
    speed = speed_of_teeth(
        passed, wheelset.tooth_pitch, time - wheelset.tooth_time, wheelset.timer_resolution
    )
    moved = select(begins, 1.0, passed) > 0.0
    wheelset.tooth_speed = select(begins, configured_speed, select(moved, speed, wheelset.tooth_speed))
    wheelset.last_tooth = tooth
    wheelset.tooth_time = select(moved, time, wheelset.tooth_time)
    wheelset.tooth_rate = tooth_rate
