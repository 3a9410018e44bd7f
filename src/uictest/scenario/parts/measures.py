"""Definitions of the measures: the parameters of sliding, locking and the filtered deceleration."""

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from uictest.scenario.yaml import Part, Quantity, of_kind

Speed = Annotated[Quantity, of_kind("speed", at_least="0.001 km/h", at_most="100 km/h")]


class MeasureDefinitions(Part):
    """The definitions of the measures of every stop, simulated or recorded."""

    folder: ClassVar[str] = "measures"

    schema_id: Literal["uictest/measures/1"] = Field(
        default="uictest/measures/1", alias="schema", description="What the file holds: uictest/measures/1."
    )
    sliding_slide: Annotated[Quantity, of_kind("share", at_least="0.001 %", at_most="100 %")] = Field(
        description="Relative slide from which a wheelset counts as sliding."
    )
    sliding_slip: Speed = Field(description="Slip speed that a sliding wheelset must have as well.")
    locked_speed: Speed = Field(description="Wheel speed below which a wheelset counts as locked.")
    moving_speed: Speed = Field(
        description="Train speed above which slides, locks and decelerations are observed."
    )
    deceleration_filter: Annotated[Quantity, of_kind("time", at_least="0 s", at_most="10 s")] = Field(
        description="Time constant of the low-pass of the deceleration."
    )
    developed_time: Annotated[Quantity, of_kind("time", at_least="0 s", at_most="60 s")] = Field(
        description="Time after the command from which the smallest deceleration is kept."
    )
