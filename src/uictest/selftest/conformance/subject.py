"""The controller that is checked."""

from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

from uictest.controllers import (
    CONTROLLERS,
    CalledInstance,
    Config,
    Controller,
    ControllerProgram,
    Inputs,
    Outputs,
)
from uictest.core.physics import FILL, VENT
from uictest.core.record import fields_of
from uictest.selftest.conformance.situations import INITIAL_SPEED, WHEELSETS, wheel_radius


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
        self._parameters = parameters
        self._initial_speed = config.initial_speed

    def reset(self) -> None:
        """Begin a stop."""
        self._train: Any = _blank(self._controller.train_memory)
        self._wheelsets: list[Any] = [_blank(self._controller.wheelset_memory) for _ in range(WHEELSETS)]
        self._controller.begin(self._train, self._wheelsets, self._initial_speed)

    def step(self, inputs: Inputs) -> Outputs:
        """Decide as in a stop."""
        readings = zip(self._wheelsets, inputs.wheel_speed, inputs.speed_valid, strict=True)
        for wheelset, speed, valid in readings:
            wheelset.measured_speed, wheelset.speed_valid = speed, int(valid)
        self._controller.decide(self._train, self._wheelsets, self._parameters)
        commands = [wheelset.valve_command for wheelset in self._wheelsets]
        return Outputs(
            hold=[command != FILL for command in commands],
            vent=[command == VENT for command in commands],
            reference_speed=self._train.reference_speed,
        )


def _blank(record: Any) -> Any:
    return SimpleNamespace(**dict.fromkeys(fields_of(record), 0))
