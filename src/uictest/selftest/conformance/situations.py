"""Situations that a controller is driven through: what its sensors show, cycle by cycle.

The speeds do not depend on what the controller answers. Speeds, decelerations and durations are chosen; the
errors of the speed sensor are those of the library's standard sensors. A process makes each situation once.
"""

from dataclasses import dataclass
from functools import cache
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.controllers import INPUTS
from uictest.core.physics import bell, speed_reading, threefry
from uictest.core.units import BAR, KILOMETRE_PER_HOUR
from uictest.plans.scenario import load_part

Array = NDArray[np.float64]
WHEELSETS: Final = 4
INITIAL_SPEED: Final = 120 * KILOMETRE_PER_HOUR
"""Of every situation, m/s; chosen."""
FULL_PRESSURE: Final = 3.8 * BAR
"""Brake cylinder pressure of full service, Pa gauge; chosen."""
DRY_DECELERATION: Final = 1.2
"""Of a train on a good rail, m/s2; chosen, of the size of full service in brake position R."""
WET_DECELERATION: Final = 0.8
"""Of a train with a sliding wheelset, m/s2; chosen."""
SLIDE_BEGINS: Final = 2.0
"""Time at which a wheelset begins to slide, s; chosen."""
SLIDE_DECELERATION: Final = 8.0
"""Of a wheelset that slides, m/s2; chosen, of the size that low adhesion leaves of a brake's torque."""
DEEPEST_SLIDE: Final = 0.6
"""Relative slide at which a sliding wheelset no longer loses speed against the train; chosen."""
ROLLS_AGAIN: Final = 6.0
"""Time at which a wheelset that has slid rolls again, s; chosen."""
REACCELERATION: Final = 10.0
"""Of a wheelset on the way back to rolling, m/s2; chosen."""
SENSOR_FAILS: Final = 2.0
"""Time at which a speed sensor reports a fault, s; chosen."""
AXLE_LOAD: Final = 110e3
"""Of a car with a dynamic brake, N; chosen, of the size of an empty passenger car's."""
_SLIDING_UNTIL: Final = 14.0
_LOCKED_FOR: Final = 20.0
_STANDSTILL: Final = 3.0
_BEGINNING: Final = 50


@dataclass(frozen=True, slots=True)
class Situation:
    """What the sensors show.

    Attributes:
        inputs: one record of :data:`~uictest.controllers.INPUTS` for each cycle.
        train_speed: true speed of the train in each cycle, m/s; no controller sees it.
    """

    inputs: NDArray[Any]
    train_speed: Array

    @property
    def time(self) -> Array:
        """Time of each cycle, s."""
        times: Array = self.inputs["time"]
        return times


@cache
def good_rail(cycle_time: float) -> Situation:
    """A stop in which every wheelset rolls, and the standstill after it."""
    time = _times(INITIAL_SPEED / DRY_DECELERATION + _STANDSTILL, cycle_time)
    train = np.maximum(INITIAL_SPEED - DRY_DECELERATION * time, 0.0)
    return _situation(cycle_time, train, np.tile(train, (WHEELSETS, 1)))


@cache
def one_slides(cycle_time: float, wheelset: int) -> Situation:
    """A wheelset slides, goes on sliding, and rolls again; the others roll."""
    train, speeds = _braking(cycle_time, _SLIDING_UNTIL)
    time = _times(_SLIDING_UNTIL, cycle_time)
    deepest = train * (1.0 - DEEPEST_SLIDE)
    falling = train - (SLIDE_DECELERATION - WET_DECELERATION) * np.maximum(time - SLIDE_BEGINS, 0.0)
    sliding = np.maximum(falling, deepest)
    at_end = INITIAL_SPEED - WET_DECELERATION * ROLLS_AGAIN
    rising = at_end * (1.0 - DEEPEST_SLIDE) + REACCELERATION * (time - ROLLS_AGAIN)
    speeds[wheelset] = np.where(time < ROLLS_AGAIN, sliding, np.minimum(rising, train))
    return _situation(cycle_time, train, speeds)


@cache
def motor_slides(cycle_time: float, wheelset: int) -> Situation:
    """A wheelset slides and rolls again as in :func:`one_slides`, under a dynamic brake of all four."""
    situation = one_slides(cycle_time, wheelset)
    inputs = situation.inputs.copy()
    inputs["dynamic_brake"] = inputs["brake_command"] = 1.0
    inputs["axle_load"] = AXLE_LOAD
    return Situation(inputs, situation.train_speed)


@cache
def locked(cycle_time: float, wheelsets: tuple[int, ...]) -> Situation:
    """Some wheelsets stand still, or their sensors show it, while the train brakes."""
    train, speeds = _braking(cycle_time, _LOCKED_FOR)
    speeds[list(wheelsets)] = 0.0
    return _situation(cycle_time, train, speeds)


@cache
def sensor_lost(cycle_time: float, wheelset: int) -> Situation:
    """One speed sensor reports a fault and reads zero while every wheelset rolls."""
    train, speeds = _braking(cycle_time, _LOCKED_FOR)
    lost = _times(_LOCKED_FOR, cycle_time) >= SENSOR_FAILS
    speeds[wheelset, lost] = 0.0
    situation = _situation(cycle_time, train, speeds)
    situation.inputs["speed_valid"][lost, wheelset] = 0
    return situation


@cache
def anything(cycle_time: float, cycles: int = 3000) -> Situation:
    """Speeds, faults and demands that change at random, the same ones each time."""
    draw = np.random.default_rng(1)
    begins = np.sort(draw.integers(0, cycles, cycles // 40))
    segment = np.searchsorted(begins, np.arange(cycles), side="right")
    age = (np.arange(cycles) - np.concatenate(([0], begins))[segment]) * cycle_time
    train = (draw.uniform(0.0, 70.0, cycles) * draw.choice((0.0, 1.0), cycles, p=(0.1, 0.9)))[segment]
    share = draw.choice((0.0, 0.5, 0.98, 1.0, 1.2), (WHEELSETS, cycles))[:, segment]
    change = draw.uniform(-10.0, 5.0, (WHEELSETS, cycles))[:, segment]
    speeds = np.maximum(train * share + change * age, 0.0) * (train > 0.0)
    # All slide at first: only what a controller remembers from its reset tells it so.
    train[:_BEGINNING], speeds[:, :_BEGINNING] = INITIAL_SPEED, 0.9 * INITIAL_SPEED
    situation = _situation(cycle_time, train, speeds)
    situation.inputs["brake_demand"] = draw.choice((0.0, 0.3, 1.0), cycles)[segment]
    situation.inputs["speed_valid"] = draw.choice((0, 1), (cycles, WHEELSETS), p=(0.1, 0.9))[segment]
    situation.inputs["speed_valid"][-_BEGINNING:] = 0  # all sensors at once
    situation.inputs["cylinder_pressure"] *= situation.inputs["brake_demand"][:, np.newaxis]
    return situation


def _times(duration: float, cycle_time: float) -> Array:
    return cycle_time * np.arange(round(duration / cycle_time), dtype=np.float64)


def _braking(cycle_time: float, duration: float) -> tuple[Array, Array]:
    """Return the speeds of a train and of its rolling wheelsets."""
    train = np.maximum(INITIAL_SPEED - WET_DECELERATION * _times(duration, cycle_time), 0.0)
    return train, np.tile(train, (WHEELSETS, 1))


def _situation(cycle_time: float, train: Array, speeds: Array) -> Situation:
    inputs = np.zeros(len(train), INPUTS)
    inputs["cycle"] = np.arange(len(train))
    inputs["time"] = inputs["cycle"] * cycle_time
    inputs["wheel_speed"] = _measured(speeds.T, cycle_time)
    inputs["speed_valid"] = 1
    inputs["cylinder_pressure"] = FULL_PRESSURE
    inputs["brake_demand"] = 1.0
    return Situation(inputs, train)


def _measured(speeds: Array, cycle_time: float) -> Array:
    """Return speeds as the standard sensors show them."""
    sensor: Any = _part("sensors/standard").speed
    pitch = 2.0 * np.pi * wheel_radius() / float(sensor.teeth)
    noise = float(sensor.noise)
    settings = pitch, float(sensor.timer_resolution), cycle_time, float(sensor.minimum_speed)
    return np.array(
        [
            [
                speed_reading(speed, *settings, noise * _draw(cycle, wheelset))
                for wheelset, speed in enumerate(row)
            ]
            for cycle, row in enumerate(speeds.tolist())
        ]
    )


@cache
def _draw(cycle: int, wheelset: int) -> float:
    """Return the draw of a sensor's noise, which is the same in every situation."""
    return bell(*threefry(0, 0, cycle, wheelset))


@cache
def wheel_radius() -> float:
    """Return the wheel radius of the library's default vehicle, m."""
    return float(_part("vehicles/intercity-180").wheelset.radius)


@cache
def _part(reference: str) -> Any:
    return load_part(reference)
