"""The WSP controller under test: its algorithm and every threshold."""

from collections.abc import Iterator
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from uictest.scenario.yaml import Inconsistency, Part, Quantity, of_kind

Duration = Annotated[Quantity, of_kind("time", at_least="1 ms", at_most="60 s")]
Deceleration = Annotated[Quantity, of_kind("acceleration", at_least="0.001 m/s2", at_most="100 m/s2")]
Slide = Annotated[Quantity, of_kind("share", at_least="0 %", at_most="100 %")]
WalkingPace = Annotated[Quantity, of_kind("speed", at_least="0.001 km/h", at_most="100 km/h")]


class ControllerPart(Part):
    """What every controller has."""

    folder: ClassVar[str] = "controllers"

    schema_id: Literal["uictest/controller/1"] = Field(
        default="uictest/controller/1",
        alias="schema",
        description="What the file holds: uictest/controller/1.",
    )
    cycle_time: Annotated[Quantity, of_kind("time", at_least="1 ms", at_most="1 s")] = Field(
        description="Time between two decisions."
    )
    reference_deceleration: Deceleration = Field(
        description="Fastest fall of the estimate of the train's speed (positive number)."
    )
    minimum_speed: WalkingPace = Field(
        description="Estimated train speed below which the controller leaves the brake alone."
    )


class ThresholdController(ControllerPart):
    """Fill, hold or vent by slip speed, slide and acceleration of each wheelset."""

    algorithm: Literal["threshold"] = Field(description="The algorithm that reads these numbers.")
    slip_threshold: Annotated[Quantity, of_kind("speed", at_least="0.001 km/h", at_most="100 km/h")] = Field(
        description="Slip speed from which a wheelset counts as sliding."
    )
    slide_threshold: Slide = Field(
        description="Share of the estimated train speed that is added to the slip threshold."
    )
    deep_slide: Slide = Field(
        description="Relative slide beyond which a vent goes on until the wheelset gains speed."
    )
    vent_deceleration: Deceleration = Field(
        description="Deceleration of a wheelset (positive number) beyond which its tank is vented."
    )
    hold_deceleration: Deceleration = Field(
        description="Deceleration of a wheelset (positive number) below which a vent turns into a hold."
    )
    reacceleration_threshold: Deceleration = Field(
        description="Acceleration of a wheelset from which it counts as regaining speed."
    )
    acceleration_filter_time: Annotated[Quantity, of_kind("time", at_least="0 s", at_most="1 s")] = Field(
        description="Time constant of the filter of wheelset acceleration."
    )
    holding_deceleration: Deceleration = Field(
        description="Fall of the estimate of the train's speed while every wheelset slides (positive number)."
    )
    rolling_time: Duration = Field(
        description="Time in which a wheelset must not have slid to show the train's speed."
    )
    sounding_interval: Duration = Field(
        description="Time without a rolling wheelset after which one is released to find the train's speed."
    )
    sounding_time: Duration = Field(
        description="Shortest vent of a wheelset that is released to find the train's speed."
    )
    recovery_share: Slide = Field(
        description="Share of the slide threshold below which a wheelset has caught up."
    )
    vent_watchdog: Duration = Field(description="Longest vent; then the tank is filled again.")
    hold_limit: Duration = Field(description="Longest hold; then the tank is vented or filled.")
    fill_pulse_on: Duration = Field(
        description="Filling time of one pulse while the pressure is restored in steps."
    )
    fill_pulse_off: Annotated[Quantity, of_kind("time", at_least="0 s", at_most="60 s")] = Field(
        description="Pause after such a pulse."
    )
    refill_time: Duration = Field(description="Time of filling in pulses after which the tank fills freely.")

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield durations too short for the controller to see, and thresholds in the wrong order."""
        yield from super().inconsistencies()
        for name in ("vent_watchdog", "hold_limit", "fill_pulse_on"):
            duration: Quantity = getattr(self, name)
            if duration < self.cycle_time:
                yield Inconsistency(
                    (name,), f"{duration.text} is shorter than one controller cycle ({self.cycle_time.text})"
                )
        if self.holding_deceleration > self.reference_deceleration:
            yield Inconsistency(("holding_deceleration",), "it must not exceed reference_deceleration")
        if self.hold_deceleration >= self.vent_deceleration:
            yield Inconsistency(
                ("hold_deceleration",), "a vent would end at once: it must be below vent_deceleration"
            )


class SlipBandController(ControllerPart):
    """Fill below a lower slide, vent above an upper one, hold between them."""

    algorithm: Literal["slip-band"] = Field(description="The algorithm that reads these numbers.")
    lower_slide: Slide = Field(description="Slide below which the tank is filled.")
    upper_slide: Slide = Field(description="Slide above which the tank is vented.")

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield a band that is upside down."""
        yield from super().inconsistencies()
        if self.lower_slide >= self.upper_slide:
            yield Inconsistency(("lower_slide",), "it must be below upper_slide")


Controller = Annotated[ThresholdController | SlipBandController, Field(discriminator="algorithm")]
"""A controller of any algorithm."""
