"""The controller that is checked."""

from dataclasses import dataclass
from typing import Any

from uictest.controllers import CONTROLLERS, Config, Controller, ControllerProgram
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
