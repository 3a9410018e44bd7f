"""Definitions of the measures: the parameters of sliding, locking and the filtered deceleration."""

from collections.abc import Iterator
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from uictest.plans.scenario.yaml import Inconsistency, Part, Quantity, default, of_kind

Speed = Annotated[Quantity, of_kind("speed", at_least="0.001 km/h", at_most="100 km/h")]

Share = Annotated[Quantity, of_kind("share", at_least="0.001 %", at_most="100 %")]


class MeasureDefinitions(Part):
    """The definitions of the measures of every stop, simulated or recorded."""

    folder: ClassVar[str] = "measures"

    schema_id: Literal["uictest/measures/1"] = Field(
        default="uictest/measures/1", alias="schema", description="What the file holds: uictest/measures/1."
    )
    sliding_slide: Share = Field(description="Relative slide from which a wheelset counts as sliding.")
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
    rising_share: Share = Field(
        description="Share of the commanded pressure at which the brake-line pressure counts as rising."
    )
    developed_share: Share = Field(
        description="Share of the commanded pressure at which the brake counts as built up."
    )
    reduced_share: Share = Field(
        description="Share of the brake-line pressure below which a tank counts as held down by the WSP."
    )
    released_share: Annotated[Quantity, of_kind("share", at_least="0 %", at_most="100 %")] = Field(
        default=default("20 %", "share"),
        description="Share of the largest clamping force below which a wheelset is without brake force.",
    )

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield a brake that is built up before its pressure rises."""
        yield from super().inconsistencies()
        if self.developed_share <= self.rising_share:
            yield Inconsistency(
                ("developed_share",),
                f"{self.developed_share.text} is not above rising_share = {self.rising_share.text}",
                "the brake is built up after its pressure has begun to rise",
            )
