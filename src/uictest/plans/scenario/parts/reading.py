"""How the words of a criterion are read, and the stops that it applies to."""

from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Field

from uictest.core.measures import MEASURES
from uictest.plans.scenario.parts.bounded_measure import StopMeasureName
from uictest.plans.scenario.parts.definition import Definition
from uictest.plans.scenario.yaml import SCENARIO_SOURCE, Inconsistency, Model, Quantity, of_kind, quoted

ID = r"^[a-z0-9][a-z0-9._-]{0,99}$"
WHEELSET_COUNT = 4
"""Wheelsets of the car."""


class AtLeast(Model):
    """How many wheelsets must keep the bound."""

    at_least: Literal["half"] | Annotated[int, Field(ge=1, le=WHEELSET_COUNT, strict=True)] = Field(
        description="A number of wheelsets, or `half` of them (rounded up)."
    )


WheelsetsThatKeep = Literal["all", "any"] | AtLeast | None


class Reading(Model):
    """Another measure that the words of a criterion may mean, held against the same bounds.

    It never changes the status of the criterion: where it comes out otherwise, the verdict turns.
    """

    id: str = Field(pattern=ID, description="Name of the reading in every report.")
    source: str = Field(
        default=SCENARIO_SOURCE, description="A key of the part's `sources`: where the reading comes from."
    )
    measure: StopMeasureName = Field(description="The measure that is read.")
    wheelsets: WheelsetsThatKeep = Field(
        default=None, description="For a measure of wheelsets: how many of them must keep the bounds."
    )
    definition: Definition = Field(
        default=Definition(), description="The definitions that the measure needs."
    )

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield a wrong number of wheelsets, missing or unused definitions."""
        yield from wheelsets_problems(self.measure, self.wheelsets)
        yield from definition_problems(self.measure, self.definition)


def wheelsets_problems(measure: str, wheelsets: WheelsetsThatKeep) -> Iterator[Inconsistency]:
    """Yield that a measure of wheelsets lacks their number, or another measure has one."""
    if MEASURES[measure].of_wheelsets and wheelsets is None:
        yield Inconsistency(
            (),
            f"{quoted(measure)} has a value per wheelset: 'wheelsets' must say how many keep it",
            "write 'wheelsets: all', 'wheelsets: any' or 'wheelsets: {at_least: half}'",
        )
    if not MEASURES[measure].of_wheelsets and wheelsets is not None:
        yield Inconsistency(
            ("wheelsets",), f"{quoted(measure)} is a measure of the whole stop, not of wheelsets"
        )


def definition_problems(measure: str, definition: Definition) -> Iterator[Inconsistency]:
    """Yield the definitions that a measure lacks, and those that it does not use."""
    needed, defined = MEASURES[measure].definitions, definition.parameters()
    for name in needed:
        if name not in defined:
            yield Inconsistency(
                (),
                f"{quoted(measure)} needs the definition {quoted(name)}, which is missing",
                "write it under 'definition'",
            )
    for name in defined:
        if name not in needed:
            yield Inconsistency(
                ("definition", name), f"{quoted(measure)} does not use the definition {quoted(name)}"
            )


class NominalSpeed(Model):
    """An initial speed with the tolerance within which a stop is judged, uncorrected."""

    value: Annotated[Quantity, of_kind("speed", above="0 km/h", at_most="600 km/h")] = Field(
        description="Nominal initial speed."
    )
    tolerance: Annotated[Quantity, of_kind("speed", at_least="0 km/h", at_most="600 km/h")] = Field(
        description="Largest deviation either way."
    )


class NominalShare(Model):
    """A brake command with its tolerance."""

    value: Annotated[Quantity, of_kind("share", above="0 %", at_most="100 %")] = Field(
        description="Nominal command."
    )
    tolerance: Annotated[Quantity, of_kind("share", at_least="0 %", at_most="100 %")] = Field(
        description="Largest deviation either way."
    )


class NominalGradient(Model):
    """A gradient with its tolerance."""

    value: Annotated[Quantity, of_kind("gradient", at_least="-60 permille", at_most="60 permille")] = Field(
        description="Nominal gradient, positive uphill."
    )
    tolerance: Annotated[Quantity, of_kind("gradient", at_least="0 permille", at_most="120 permille")] = (
        Field(description="Largest deviation either way.")
    )


Nominal = NominalSpeed | NominalShare | NominalGradient


class Applicability(Model):
    """Conditions of a stop under which a criterion applies; a condition that is not named is not checked."""

    rail_condition: tuple[str, ...] | None = Field(
        default=None, description="Names of rail conditions, e.g. wet."
    )
    rail_condition_other_than: tuple[str, ...] | None = Field(
        default=None, description="Names of rail conditions that the criterion is not for, e.g. dry."
    )
    rail_cleaned: bool | None = Field(
        default=None,
        strict=True,
        description="Whether sliding cleans the rail; a recorded rail answers as it does and meets either.",
    )
    wsp: tuple[Literal["active", "bypassed"], ...] | None = Field(
        default=None, description="States of the WSP."
    )
    brake_position: tuple[str, ...] | None = Field(default=None, description="Brake positions, e.g. R.")
    topology: tuple[Literal["one-caliper", "four-caliper"], ...] | None = Field(
        default=None, description="Topologies of the rig."
    )
    initial_speed: NominalSpeed | None = Field(default=None, description="Initial speed, uncorrected.")
    command: NominalShare | None = Field(default=None, description="Share of the full service command.")
    gradient: NominalGradient | None = Field(default=None, description="Gradient of the track.")
