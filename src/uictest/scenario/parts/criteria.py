"""Criteria: bounds on the measures of a stop, when they apply, and the definitions of their words."""

from collections.abc import Iterator
from typing import Annotated, ClassVar, Literal

from pydantic import (
    AfterValidator,
    Field,
    PlainSerializer,
    PlainValidator,
    ValidationInfo,
    WithJsonSchema,
)
from pydantic_core import PydanticCustomError

from uictest.measures import MEASURES, Course, Measure
from uictest.scenario.parts.applicability import Applicability
from uictest.scenario.parts.definition import Definition
from uictest.scenario.yaml import (
    SCENARIO_SOURCE,
    Inconsistency,
    Model,
    Part,
    Quantity,
    QuantityField,
    quoted,
    suggestion,
    written,
)
from uictest.units import KINDS

WHEELSET_COUNT = 4
"""Wheelsets of the car."""


def _known_measure(name: str) -> str:
    if name not in MEASURES:
        context = {"message": f"unknown measure {quoted(name)}", "hint": suggestion(name, MEASURES)}
        raise PydanticCustomError("measure", "{message}", context)
    return name


def _of_the_measure(bound: object, info: ValidationInfo) -> object:
    # Without a valid measure its kind is not known; the model is rejected for that already.
    measure = MEASURES.get(info.data.get("measure", ""))
    return bound if measure is None else QuantityField(KINDS[measure.kind]).validate(bound)


MeasureName = Annotated[
    str, AfterValidator(_known_measure), WithJsonSchema({"type": "string", "enum": sorted(MEASURES)})
]

Bound = Annotated[
    Quantity,
    PlainValidator(_of_the_measure),
    PlainSerializer(written),
    WithJsonSchema({"type": ["string", "number", "object"]}),
]
"""A quantity of whatever kind the measure of the criterion is."""


class AtLeast(Model):
    """How many wheelsets must keep the bound."""

    at_least: Literal["half"] | Annotated[int, Field(ge=1, le=WHEELSET_COUNT, strict=True)] = Field(
        description="A number of wheelsets, or `half` of them (rounded up)."
    )


class Criterion(Model):
    """One bound on one measure."""

    id: str = Field(
        pattern=r"^[a-z0-9][a-z0-9._-]{0,99}$", description="Name of the criterion in every report."
    )
    title: str = Field(default="", max_length=200, description="One line for people.")
    source: str = Field(
        default=SCENARIO_SOURCE,
        description="A key of the part's `sources`: where the bound is stated.",
    )
    clause: str = Field(
        default="unverified", max_length=200, description="Clause of the source, or `unverified`."
    )
    layer: Literal["validity", "requirement"] = Field(
        description="validity: if it fails, the stop is no test; requirement: if it fails, the stop fails."
    )
    applies: Applicability = Field(
        default=Applicability(), description="Stops that the criterion applies to."
    )
    measure: MeasureName = Field(description="The measure that is bounded.")
    lower: Bound | None = Field(default=None, description="Lower bound; a quantity of the measure's kind.")
    upper: Bound | None = Field(default=None, description="Upper bound; a quantity of the measure's kind.")
    strict: bool = Field(
        default=False, strict=True, description="Whether a value at the bound itself does not pass."
    )
    wheelsets: Literal["all", "any"] | AtLeast | None = Field(
        default=None, description="For a measure of wheelsets: how many of them must keep the bounds."
    )
    definition: Definition = Field(
        default=Definition(), description="The definitions that the measure needs."
    )

    @property
    def unit(self) -> str:
        """The unit value and bounds are printed in."""
        return self._declared.unit

    @property
    def meaning(self) -> str:
        """What the measure is, in words."""
        return self._declared.meaning

    @property
    def observed_by(self) -> tuple[str, ...]:
        """The fields of the scenario's `measures` part that decide what was observed."""
        return self._declared.observed_by

    @property
    def course(self) -> Course:
        """What the measure's value can do while the stop goes on."""
        return self._declared.course

    @property
    def of_simulation(self) -> bool:
        """Whether the measure describes the simulation itself, not a train."""
        return self._declared.of_simulation

    @property
    def aggregation(self) -> str:
        """Which wheelsets must keep the bounds, in words; empty for a measure of the stop."""
        if isinstance(self.wheelsets, AtLeast):
            return f"at least {self.wheelsets.at_least}"
        return self.wheelsets or ""

    def wheelsets_needed(self, count: int) -> int:
        """Return how many of `count` values must keep the bounds (1 for a measure of the stop)."""
        if isinstance(self.wheelsets, AtLeast):
            return (count + 1) // 2 if self.wheelsets.at_least == "half" else self.wheelsets.at_least
        return count if self.wheelsets == "all" else 1

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield missing or crossed bounds, a wrong number of wheelsets, missing or unused definitions."""
        yield from self._bound_problems()
        yield from self._wheelsets_problems()
        yield from self._definition_problems()

    @property
    def _declared(self) -> Measure:
        return MEASURES[self.measure]

    def _bound_problems(self) -> Iterator[Inconsistency]:
        if self.lower is None and self.upper is None:
            yield Inconsistency(
                (), f"criterion {quoted(self.id)} has no bound", "write 'lower', 'upper' or both"
            )
        elif self.lower is not None and self.upper is not None and self.lower > self.upper:
            yield Inconsistency(
                ("lower",), f"the lower bound {self.lower.text} is above the upper bound {self.upper.text}"
            )

    def _wheelsets_problems(self) -> Iterator[Inconsistency]:
        if self._declared.of_wheelsets and self.wheelsets is None:
            yield Inconsistency(
                (),
                f"{quoted(self.measure)} has a value per wheelset: 'wheelsets' must say how many keep it",
                "write 'wheelsets: all', 'wheelsets: any' or 'wheelsets: {at_least: half}'",
            )
        if not self._declared.of_wheelsets and self.wheelsets is not None:
            yield Inconsistency(
                ("wheelsets",), f"{quoted(self.measure)} is a measure of the whole stop, not of wheelsets"
            )

    def _definition_problems(self) -> Iterator[Inconsistency]:
        needed, defined = self._declared.definitions, self.definition.parameters()
        for name in needed:
            if name not in defined:
                yield Inconsistency(
                    (),
                    f"{quoted(self.measure)} needs the definition {quoted(name)}, which is missing",
                    "write it under 'definition'",
                )
        for name in defined:
            if name not in needed:
                yield Inconsistency(
                    ("definition", name), f"{quoted(self.measure)} does not use the definition {quoted(name)}"
                )


class Criteria(Part):
    """A profile: criteria that belong together."""

    folder: ClassVar[str] = "criteria"

    schema_id: Literal["uictest/criteria/1"] = Field(
        default="uictest/criteria/1", alias="schema", description="What the file holds: uictest/criteria/1."
    )
    # Not min_length: pydantic would also call a list too short all of whose criteria are wrong.
    criteria: tuple[Criterion, ...] = Field(
        description="The criteria, judged in this order.", json_schema_extra={"minItems": 1}
    )

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield sources that are not described and criteria of the same name."""
        yield from super().inconsistencies()
        yield from self._undescribed_sources()
        if not self.criteria:
            yield Inconsistency(("criteria",), "the profile has no criterion", "write at least one")
        seen: set[str] = set()
        for index, criterion in enumerate(self.criteria):
            if criterion.id in seen:
                yield Inconsistency(
                    ("criteria", index, "id"), f"a second criterion is called {quoted(criterion.id)}"
                )
            seen.add(criterion.id)

    def _undescribed_sources(self) -> Iterator[Inconsistency]:
        for index, criterion in enumerate(self.criteria):
            if criterion.source not in {SCENARIO_SOURCE, *self.sources}:
                yield Inconsistency(
                    ("criteria", index, "source"),
                    f"unknown source {quoted(criterion.source)}",
                    suggestion(criterion.source, self.sources) or "describe it under 'sources'",
                )
