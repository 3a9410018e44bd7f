"""Drive a controller through the situations, each once, in a child process where it comes from outside."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from types import TracebackType
from typing import Any, Self

from uictest import rig
from uictest.controllers import ControllerError
from uictest.selftest.conformance import situations
from uictest.selftest.conformance.situations import WHEELSETS, Situation
from uictest.selftest.conformance.subject import PlainInstance, Subject

REPEATED: tuple[rig.Beginning, ...] = ("create", "reset", "create")


class Answers:
    """A situation and what the controller has answered in it.

    Attributes:
        situation: what its sensors showed.
        drives: its answers; several where the situation was repeated.
    """

    def __init__(self, situation: Situation, drives: tuple[rig.Driven, ...]) -> None:
        self.situation = situation
        self.drives = drives

    @property
    def hold(self) -> Any:
        """Holding magnets, shape (cycles, wheelsets)."""
        return self.drives[0].outputs["hold"]

    @property
    def vent(self) -> Any:
        """Venting magnets, shape (cycles, wheelsets)."""
        return self.drives[0].outputs["vent"]

    @property
    def reference_speed(self) -> Any:
        """Estimated speed of the train, m/s, shape (cycles,)."""
        return self.drives[0].outputs["reference_speed"]


class Bench:
    """A controller and what it has answered so far; `asked` holds what was asked for since it was emptied."""

    def __init__(self, subject: Subject) -> None:
        self.subject = subject
        self.version = ""
        self._cycle_time = subject.config.cycle_time
        self._driven: dict[str, Answers | ControllerError] = {}
        self.asked: dict[str, Answers] = {}
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
        return self._once(
            f"wheelset {wheelset + 1} slides", partial(situations.one_slides, wheelset=wheelset)
        )

    def locked(self, *wheelsets: int) -> Answers:
        """Answers while some wheelsets stand still."""
        listed = ", ".join(str(wheelset + 1) for wheelset in wheelsets)
        return self._once(f"wheelset {listed} locked", partial(situations.locked, wheelsets=wheelsets))

    def sensor_lost(self, wheelset: int) -> Answers:
        """Answers while the speed sensor of one wheelset reports a fault."""
        return self._once(
            f"speed sensor of wheelset {wheelset + 1} lost",
            partial(situations.sensor_lost, wheelset=wheelset),
        )

    def anything(self) -> Answers:
        """Answers to random inputs: of a new controller, after a reset, and of a second one."""
        return self._once("anything", situations.anything, REPEATED)

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
        situation_at: Callable[[float], Situation],
        beginnings: tuple[rig.Beginning, ...] = ("create",),
    ) -> Answers:
        if name not in self._driven:
            situation = situation_at(self._cycle_time)
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
        drives = self._workers.drive(rig.DriveRequest(program, config, situation.inputs, beginnings))
        self.version = drives.version
        return drives.drives

    def _drive_plain(self, situation: Situation) -> rig.Driven:
        controller, parameters = self.subject.built_in, self.subject.parameters
        if controller is None:
            raise ValueError("neither built in nor a program")
        instance = PlainInstance(controller, parameters, self.subject.config)
        instance.reset()
        return rig.drive(instance, situation.inputs, self._cycle_time, rig.empty_exchange())
