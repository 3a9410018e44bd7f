"""The models of a validation file."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any, Final, Literal

from pydantic import Field

from uictest.plans.scenario import Slug
from uictest.plans.scenario.yaml import Inconsistency, Model, Quantity, default, of_kind

VALIDATION_SCHEMA: Final = "uictest/validation/1"


class RecordedStops(Model):
    """Recorded stops that one scenario describes."""

    scenario: str = Field(description="Relative path of the scenario.")
    recordings: tuple[str, ...] = Field(min_length=1, description="Relative paths of the recorded stops.")
    map: str = Field(
        default="uictest", description="Channel map of the recordings: a preset or a relative path."
    )
    set: dict[str, Any] = Field(default={}, description="Values by dotted key of the scenario.")
    repeat: Annotated[int, Field(ge=1, le=1000, strict=True)] | None = Field(
        default=None, description="Seeds under which each stop is simulated; the medians are compared."
    )
    tuned: bool = Field(
        default=False,
        description="Whether numbers of the scenario were found with these recordings: they then show"
        " nothing, and are listed without being counted.",
    )


class ValidationFile(Model):
    """Recorded stops and the scenarios that simulate them."""

    schema_id: Literal["uictest/validation/1"] = Field(
        alias="schema", description="What the file holds and in which version: uictest/validation/1."
    )
    name: Slug = Field(description="Name: lower-case letters, digits, dots, dashes and underscores.")
    title: str = Field(
        default="", max_length=200, pattern=r"^[^\x00-\x1f\x7f]*$", description="One line for people."
    )
    stops: tuple[RecordedStops, ...] = Field(description="The recorded stops.")
    speed_tolerance: Annotated[Quantity, of_kind("speed", at_least="0 km/h", at_most="50 km/h")] = Field(
        default=default("3 km/h", "speed"),
        description="Largest difference of a recorded initial speed from that of its scenario.",
    )
    confidence: Annotated[Quantity, of_kind("share", at_least="50 %", at_most="99.99 %")] = Field(
        default=default("95 %", "share"), description="Confidence of the intervals."
    )

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield an empty list of stops."""
        if not self.stops:
            yield Inconsistency(("stops",), "an empty list", "name at least one recorded stop")
