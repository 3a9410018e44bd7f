"""A controller on the bench: loaded, driven through situations, and what it answers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from types import SimpleNamespace, TracebackType
from typing import Any, NamedTuple, Self

from uictest import rig
from uictest.controllers import (
    CONTROLLERS,
    CalledInstance,
    Config,
    Controller,
    ControllerError,
    ControllerProgram,
    Inputs,
    Outputs,
)
from uictest.core.physics import FILL, VENT
from uictest.core.record import fields_of
from uictest.selftest.conformance import situations
from uictest.selftest.conformance.situations import INITIAL_SPEED, WHEELSETS, Situation, wheel_radius


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
        self._train: Any = _blank(self._controller.train_memory)
        self._wheelsets: list[Any] = [_blank(self._controller.wheelset_memory) for _ in range(WHEELSETS)]
        self._controller.begin(self._train, self._wheelsets, self._initial_speed)

    def step(self, inputs: Inputs) -> Outputs:
        """Decide as in a stop."""
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


def _blank(record: Any) -> Any:
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
        """What its calls have left changed in their process so far, in words."""
        self._workers = rig.Workers()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self._workers.close()

    def good_rail(self) -> Answers:
        """Answers while every wheelset rolls. Raises ControllerError, as all of these."""
        return self._once("good rail", situations.good_rail)

    def one_slides(self, wheelset: int) -> Answers:
        """Answers while one wheelset slides, then rolls again."""
        return self._once(f"wheelset {wheelset + 1} slides", situations.one_slides, wheelset=wheelset)

    def motor_slides(self, wheelset: int) -> Answers:
        """Answers while one wheelset slides under a dynamic brake, then rolls again."""
        name = f"wheelset {wheelset + 1} slides under a dynamic brake"
        return self._once(name, situations.motor_slides, wheelset=wheelset)

    def locked(self, *wheelsets: int) -> Answers:
        """Answers while some wheelsets stand still."""
        listed = ", ".join(str(wheelset + 1) for wheelset in wheelsets)
        return self._once(f"wheelset {listed} locked", situations.locked, wheelsets=wheelsets)

    def sensor_lost(self, wheelset: int) -> Answers:
        """Answers while the speed sensor of one wheelset reports a fault."""
        name = f"speed sensor of wheelset {wheelset + 1} lost"
        return self._once(name, situations.sensor_lost, wheelset=wheelset)

    def anything(self) -> Answers:
        """Answers to random inputs: of a new controller, after a reset, and of a second one."""
        return self._once("anything", situations.anything, REPEATED)

    def beside_another(self) -> Answers:
        """Answers to random inputs: of a controller alone, and of one beside another."""
        return self._once("beside another", situations.anything, ("create", "beside"))

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

    def _once(
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
