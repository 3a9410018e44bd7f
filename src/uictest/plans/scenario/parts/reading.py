"""How the words of a criterion are read: the measure, the wheelsets that must keep it, its definitions."""

from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Field

from uictest.core.measures import MEASURES
from uictest.plans.scenario.parts.bounded_measure import StopMeasureName
from uictest.plans.scenario.parts.definition import Definition
from uictest.plans.scenario.yaml import SCENARIO_SOURCE, Inconsistency, Model, quoted

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
