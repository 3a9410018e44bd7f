"""A controller on the bench: the situations that it is driven through, and what it answers.

A situation is what its sensors show, cycle by cycle; the speeds do not depend on what the controller answers.
Speeds, decelerations and durations are chosen; the errors of the speed sensor are those of the library's
standard sensors. A process makes each situation once.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from types import SimpleNamespace, TracebackType
from typing import Any, Final, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from uictest import rig
from uictest.controllers import (
    CONTROLLERS,
    INPUTS,
    CalledInstance,
    Config,
    Controller,
    ControllerError,
    ControllerProgram,
    Inputs,
    Outputs,
)
from uictest.core.physics import FILL, VENT, bell, speed_reading, threefry
from uictest.core.record import fields_of
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
    """Readings of the sensors.

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
    time = _cycle_times(INITIAL_SPEED / DRY_DECELERATION + _STANDSTILL, cycle_time)
    train = np.maximum(INITIAL_SPEED - DRY_DECELERATION * time, 0.0)
    return _situation(cycle_time, train, np.tile(train, (WHEELSETS, 1)))


@cache
def one_slides(cycle_time: float, wheelset: int) -> Situation:
    """A wheelset slides, goes on sliding, and rolls again; the others roll."""
    train, speeds = _braking_speeds(cycle_time, _SLIDING_UNTIL)
    time = _cycle_times(_SLIDING_UNTIL, cycle_time)
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
    train, speeds = _braking_speeds(cycle_time, _LOCKED_FOR)
    speeds[list(wheelsets)] = 0.0
    return _situation(cycle_time, train, speeds)


@cache
def sensor_lost(cycle_time: float, wheelset: int) -> Situation:
    """One speed sensor reports a fault and reads zero while every wheelset rolls."""
    train, speeds = _braking_speeds(cycle_time, _LOCKED_FOR)
    lost = _cycle_times(_LOCKED_FOR, cycle_time) >= SENSOR_FAILS
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


def _cycle_times(duration: float, cycle_time: float) -> Array:
    return cycle_time * np.arange(round(duration / cycle_time), dtype=np.float64)


def _braking_speeds(cycle_time: float, duration: float) -> tuple[Array, Array]:
    train = np.maximum(INITIAL_SPEED - WET_DECELERATION * _cycle_times(duration, cycle_time), 0.0)
    return train, np.tile(train, (WHEELSETS, 1))


def _situation(cycle_time: float, train: Array, speeds: Array) -> Situation:
    inputs = np.zeros(len(train), INPUTS)
    inputs["cycle"] = np.arange(len(train))
    inputs["time"] = inputs["cycle"] * cycle_time
    inputs["wheel_speed"] = _measured_speeds(speeds.T, cycle_time)
    inputs["speed_valid"] = 1
    inputs["cylinder_pressure"] = FULL_PRESSURE
    inputs["brake_demand"] = 1.0
    return Situation(inputs, train)


def _measured_speeds(speeds: Array, cycle_time: float) -> Array:
    """Return speeds as the standard sensors show them."""
    sensor: Any = _library_part("sensors/standard").speed
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
    return float(_library_part("vehicles/intercity-180").wheelset.radius)


@cache
def _library_part(reference: str) -> Any:
    return load_part(reference)


@dataclass(frozen=True, slots=True)
class Subject:
    """A controller under check.

    Attributes:
        name: what it is called in the report.
        config: what it is given.
        program: what is loaded where it comes from outside, else None.
        built_in: its functions where it is built in, else None.
        parameters: of the built-in controller.
    """

    name: str
    config: Config
    program: ControllerProgram | None = None
    built_in: Controller | None = None
    parameters: Any = None

    @property
    def description(self) -> dict[str, str]:
        """Kind, name and SHA-256."""
        if self.program is None:
            return {"kind": "built in", "name": self.name}
        digest = {"sha256": self.program.sha256} if self.program.sha256 else {}
        return {"kind": self.program.kind, "name": self.name, **digest}


def subject_of(name: str, part: Any) -> Subject:
    """Return the subject that a scenario's controller stands for.

    Args:
        name: what it is called in the report.
        part: the controller of a scenario.
    """
    program = part.program
    radii = (wheel_radius(),) * WHEELSETS
    given = {} if program is None else dict(part.parameters)
    config = Config(WHEELSETS, float(part.cycle_time), INITIAL_SPEED, radii, given)
    if program is None:
        return Subject(name, config, built_in=CONTROLLERS[part.algorithm], parameters=part)
    return Subject(name, config, program=program)


class PlainInstance(CalledInstance):
    """A controller's `begin` and `decide` on objects that have its fields and no others."""

    def __init__(self, controller: Controller, parameters: Any, config: Config) -> None:
        super().__init__()
        self._controller = controller
        self.contract = controller.contract
        self._parameters = parameters
        self._initial_speed = config.initial_speed

    def reset(self) -> None:
        """Begin a stop."""
        self._train: Any = _blank_record(self._controller.train_memory)
        self._wheelsets: list[Any] = [
            _blank_record(self._controller.wheelset_memory) for _ in range(WHEELSETS)
        ]
        self._controller.begin(self._train, self._wheelsets, self._initial_speed)

    def step(self, inputs: Inputs) -> Outputs:
        """Return the controller's answer in one cycle: copies of its inputs go in, its commands come out."""
        self._train.axle_load, self._train.brake_command = inputs.axle_load, inputs.brake_command
        self._train.train_speed, self._train.acceleration = inputs.train_speed, inputs.acceleration
        self._train.train_speed_valid = int(inputs.train_speed_valid)
        self._train.acceleration_valid = int(inputs.acceleration_valid)
        readings = zip(
            *(self._wheelsets, inputs.wheel_speed, inputs.speed_valid, inputs.dynamic_brake), strict=True
        )
        for wheelset, speed, valid, dynamic in readings:
            wheelset.measured_speed, wheelset.speed_valid = speed, int(valid)
            wheelset.dynamic_brake = dynamic
        self._controller.decide(self._train, self._wheelsets, self._parameters)
        commands = [wheelset.valve_command for wheelset in self._wheelsets]
        outputs = Outputs(
            hold=[command != FILL for command in commands],
            vent=[command == VENT for command in commands],
            reference_speed=self._train.reference_speed,
        )
        if self.contract > 1:
            outputs.dynamic_reduction = [wheelset.dynamic_reduction for wheelset in self._wheelsets]
            outputs.sand_request = [wheelset.sand_request for wheelset in self._wheelsets]
            outputs.track_brake_request = self._train.track_brake_request
        return outputs


def _blank_record(record: Any) -> Any:
    return SimpleNamespace(**dict.fromkeys(fields_of(record), 0))


REPEATED: tuple[rig.Beginning, ...] = ("create", "reset", "create")


class Answers(NamedTuple):
    """A situation and what the controller has answered in it.

    Attributes:
        situation: what its sensors showed.
        drives: its answers; several where the situation was repeated.
    """

    situation: Situation
    drives: tuple[rig.Driven, ...]

    @property
    def hold(self) -> Any:
        """Holding magnets, shape (cycles, wheelsets)."""
        return self.drives[0].outputs["hold"]

    @property
    def vent(self) -> Any:
        """Venting magnets, shape (cycles, wheelsets)."""
        return self.drives[0].outputs["vent"]

    @property
    def reduction(self) -> Any:
        """Shares taken off the dynamic brake, shape (cycles, wheelsets); of contract version 2 alone."""
        return self.drives[0].outputs["dynamic_reduction"]

    @property
    def reference_speed(self) -> Any:
        """Estimated speed of the train, m/s, shape (cycles,)."""
        return self.drives[0].outputs["reference_speed"]


class Bench:
    """A controller and what it has answered so far; `asked` holds what was asked for since it was emptied."""

    def __init__(self, subject: Subject) -> None:
        self.subject = subject
        self.version = ""
        self.contract = 1 if subject.built_in is None else subject.built_in.contract
        self._cycle_time = subject.config.cycle_time
        self._driven: dict[str, Answers | ControllerError] = {}
        self.asked: dict[str, Answers] = {}
        self.traces: dict[str, None] = {}
        """Changes that its calls have left in their process so far, in words."""
        self._workers = rig.Workers()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self._workers.close()

    def good_rail(self) -> Answers:
        """Answers while every wheelset rolls. Raises ControllerError, as all of these."""
        return self._driven_once("good rail", good_rail)

    def one_slides(self, wheelset: int) -> Answers:
        """Answers while one wheelset slides, then rolls again."""
        return self._driven_once(f"wheelset {wheelset + 1} slides", one_slides, wheelset=wheelset)

    def motor_slides(self, wheelset: int) -> Answers:
        """Answers while one wheelset slides under a dynamic brake, then rolls again."""
        name = f"wheelset {wheelset + 1} slides under a dynamic brake"
        return self._driven_once(name, motor_slides, wheelset=wheelset)

    def locked(self, *wheelsets: int) -> Answers:
        """Answers while some wheelsets stand still."""
        listed = ", ".join(str(wheelset + 1) for wheelset in wheelsets)
        return self._driven_once(f"wheelset {listed} locked", locked, wheelsets=wheelsets)

    def sensor_lost(self, wheelset: int) -> Answers:
        """Answers while the speed sensor of one wheelset reports a fault."""
        name = f"speed sensor of wheelset {wheelset + 1} lost"
        return self._driven_once(name, sensor_lost, wheelset=wheelset)

    def anything(self) -> Answers:
        """Answers to random inputs: of a new controller, after a reset, and of a second one."""
        return self._driven_once("anything", anything, REPEATED)

    def beside_another(self) -> Answers:
        """Answers to random inputs: of a controller alone, and of one together with another."""
        return self._driven_once("beside another", anything, ("create", "beside"))

    def every_situation(self) -> list[Answers]:
        """Answers in all situations."""
        places = range(WHEELSETS)
        return [
            self.good_rail(),
            *map(self.one_slides, places),
            *map(self.locked, places),
            self.locked(*places),
            *map(self.sensor_lost, places),
            self.anything(),
        ]

    def _driven_once(
        self,
        name: str,
        situation_at: Callable[..., Situation],
        beginnings: tuple[rig.Beginning, ...] = ("create",),
        **places: Any,
    ) -> Answers:
        if name not in self._driven:
            situation = situation_at(self._cycle_time, **places)
            situation.inputs.flags.writeable = False  # the next controller is driven through the same
            try:
                self._driven[name] = Answers(situation, self._drives(situation, beginnings))
            except ControllerError as error:
                self._driven[name] = ControllerError(f"{name}: {error}")
        answers = self._driven[name]
        if isinstance(answers, ControllerError):
            raise answers
        self.asked[name] = answers
        return answers

    def _drives(self, situation: Situation, beginnings: tuple[rig.Beginning, ...]) -> tuple[rig.Driven, ...]:
        program, config = self.subject.program, self.subject.config
        if program is None:
            return tuple(self._drive_plain(situation) for _ in beginnings)
        if len(beginnings) > 1:
            # What a controller keeps beyond a reset must not be there already in the first of these drives.
            self._workers.close()
            self._workers = rig.Workers()
        drives = self._workers.drive(rig.DriveRequest(program, config, situation.inputs, beginnings))
        self.version, self.contract = drives.version, drives.contract
        self.traces |= dict.fromkeys(drives.traces)
        return drives.drives

    def _drive_plain(self, situation: Situation) -> rig.Driven:
        controller, parameters = self.subject.built_in, self.subject.parameters
        if controller is None:
            raise ValueError("neither built in nor a program")
        instance = PlainInstance(controller, parameters, self.subject.config)
        instance.reset()
        return rig.drive(instance, situation.inputs, self._cycle_time, rig.empty_exchange())
