"""What every controller of a scenario has, built in or from outside."""

from typing import TYPE_CHECKING, ClassVar, Literal

from pydantic import Field

from uictest.controllers import ControllerProgram
from uictest.plans.scenario.yaml import Part, Quantity


class ControllerPart(Part):
    """What every controller has."""

    folder: ClassVar[str] = "controllers"

    schema_id: Literal["uictest/controller/1"] = Field(
        default="uictest/controller/1",
        alias="schema",
        description="What the file holds: uictest/controller/1.",
    )
    if TYPE_CHECKING:  # declared by the models, the first by those of controllers that are built in
        algorithm: str
        cycle_time: Quantity

    @property
    def program(self) -> ControllerProgram | None:
        """What is loaded where the controller comes from outside, None where it is built in."""
        return None
