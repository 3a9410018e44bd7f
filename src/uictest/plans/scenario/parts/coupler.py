"""What holds the cars of a train together: couplers, and the line that carries the brake command."""

from typing import Annotated, Literal

from pydantic import Discriminator, Tag

from uictest.plans.scenario.yaml import Model, Quantity
from uictest.plans.scenario.yaml.quantity_field import quantity


class Coupler(Model):
    """The couplers of a train, all alike: a spring and a damper without slack."""

    distance: Quantity = quantity(
        "Between the centres of neighbouring cars; 26.4 m is the usual length of a coach over its buffers.",
        "length",
        "5 m .. 60 m",
        default="26.4 m",
    )
    stiffness: Quantity = quantity(
        "Stiffness of a coupler; the default is that of open data of an eight-car unit. The least is chosen:"
        " one much softer lets cars run through each other.",
        "stiffness",
        "100 kN/m .. 100 MN/m",
        default="5 MN/m",
    )
    damping: Quantity = quantity(
        "Damping of a coupler; the default is that of open data of an eight-car unit.",
        "damping",
        "0 N s/m .. 10 MN s/m",
        default="0.8 MN s/m",
    )
    height: Quantity = quantity(
        "Height of a coupler above the rail; the default is chosen.",
        "length",
        "0 m .. 3 m",
        default="1.025 m",
    )


class Pipe(Model):
    """A pipe along the train."""

    pipe: Quantity = quantity(
        "Speed at which a command travels along the pipe; 250 m/s is usual.", "speed", "50 m/s .. 340 m/s"
    )


def _form(value: object) -> str:
    return "pipe" if isinstance(value, dict | Pipe) else "word"


Transmission = Annotated[
    Annotated[Literal["wire"], Tag("word")] | Annotated[Pipe, Tag("pipe")], Discriminator(_form)
]
"""How the brake command comes to the cars: along a wire without delay, or along a pipe."""
