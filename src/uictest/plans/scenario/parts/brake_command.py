"""The brake command: one share of full service, or a course of commands over time."""

from collections.abc import Sequence
from typing import Annotated

from pydantic import BeforeValidator, Discriminator, Field, Tag
from pydantic_core import PydanticCustomError

from uictest.core.physics import MOST_COMMANDS
from uictest.plans.scenario.yaml import Model, Quantity
from uictest.plans.scenario.yaml.quantity_field import of_kind, optional, quantity

_Share = Annotated[Quantity, of_kind("share", "1 % .. 100 %")]


class CommandStep(Model):
    """A command from one instant on, until the next one."""

    at: Quantity = quantity("Time since the first command.", "time", "0 s .. 3600 s")
    value: Quantity = quantity("Share of the full service command; 0 % releases.", "share", "0 % .. 100 %")
    position: str | None = optional("Brake position of this command; brake.position if left out.")


def _form(value: object) -> str:
    return "course" if isinstance(value, Sequence) and not isinstance(value, str) else "share"


def _steps_are_dated(value: Sequence[object]) -> Sequence[object]:
    """Refuse commands without an instant as a whole: either a course or several cases was meant."""
    if any(isinstance(each, str | int | float) for each in value):
        hint = (
            "a course is [{at: 0 s, value: 60 %}, ...]; several values go under matrix: {brake.command: ...}"
        )
        context = {"message": "commands of a course say from when on they hold", "hint": hint}
        raise PydanticCustomError("course", "{message}", context)
    return value


_Steps = Annotated[
    tuple[CommandStep, ...],
    Field(min_length=1, max_length=MOST_COMMANDS),
    BeforeValidator(_steps_are_dated),
]
Command = Annotated[
    Annotated[_Share, Tag("share")] | Annotated[_Steps, Tag("course")],
    Discriminator(_form),
]
"""One command for the whole stop, or its steps in order of time."""
