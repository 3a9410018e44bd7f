"""The brake command: one share of full service, or a course of commands over time."""

from collections.abc import Sequence
from typing import Annotated

from pydantic import Discriminator, Field, Tag

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


_Steps = Annotated[tuple[CommandStep, ...], Field(min_length=1, max_length=MOST_COMMANDS)]
Command = Annotated[
    Annotated[_Share, Tag("share")] | Annotated[_Steps, Tag("course")],
    Discriminator(_form),
]
"""One command for the whole stop, or its steps in order of time."""
