"""Criteria: bounds on the measures of a stop, when they apply, and the definitions of their words."""

from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from types import MappingProxyType
from typing import ClassVar, Final, Literal

from uictest.core.measures import MEASURES, Measure
from uictest.core.series_measures import SERIES_MEASURES, SeriesMeasure
from uictest.plans.scenario.parts.applicability import Applicability
from uictest.plans.scenario.parts.measures import (
    MEASURES_OF,
    WITH_DRY_VALUE,
    AtLeast,
    Bound,
    Definition,
    DryBound,
    MeasureName,
    Reading,
    Scope,
    WheelsetsThatKeep,
    definition_problems,
    wheelsets_problems,
)
from uictest.plans.scenario.parts.named_file import RequirementIds, repeated_requirements
from uictest.plans.scenario.yaml import (
    NAME_PATTERN,
    SCENARIO_SOURCE,
    Inconsistency,
    Model,
    Part,
    field,
    optional,
    plain,
    quoted,
    read_library,
    schema_field,
    suggestion,
    validated,
)

Stands = Literal["always", "in a valid test"]


class Criterion(Model):
    """One bound on one measure."""

    id: str = field("Name of the criterion in every report.", pattern=NAME_PATTERN)
    title: str = field("One line for people.", default="", max_length=200)
    source: str = field("A key of the part's `sources`: where the bound is stated.", default=SCENARIO_SOURCE)
    clause: str = field("Clause of the source, or `unverified`.", default="unverified", max_length=200)
    requirements: RequirementIds = field("Ids of the requirements that the criterion verifies.", default=())
    layer: Literal["rig", "validity", "requirement"] = field(
        "validity: if it fails, the stop is no test; requirement: if it fails, the stop fails;"
        " rig: a check of the rig, which makes the stop invalid and judges nothing else."
    )
    stands: Stands = field(
        "Where a requirement stands: always, or in a valid test, as labs discard and repeat others.",
        default="always",
    )
    applies: Applicability = field(
        "Stops that the criterion applies to; of a series the wet ones that are judged.",
        default=Applicability(),
    )
    scope: Scope = field(
        "stop: the criterion bounds a measure of each stop; series: one of a series of stops.", default="stop"
    )
    measure: MeasureName = field("The measure that is bounded.")
    lower: Bound | None = optional(
        "Lower bound: a quantity of the measure's kind, or such as `90 % of the dry stop`."
    )
    upper: Bound | None = optional(
        "Upper bound: a quantity of the measure's kind, or such as `125 % of the dry stop`."
    )
    strict: bool = field("Whether a value at the bound itself does not pass.", default=False, strict=True)
    wheelsets: WheelsetsThatKeep = optional(
        "For a measure of wheelsets: how many of them must keep the bounds."
    )
    definition: Definition = field("The definitions that the measure needs.", default=Definition())
    reading: str = field(
        "Name of what the criterion itself reads, where there are others.", default="", max_length=100
    )
    reading_source: str = field(
        "A key of the part's `sources`: where that reading comes from.", default=SCENARIO_SOURCE
    )
    readings: tuple[Reading, ...] = field(
        "Other readings of the same words, which never decide: where one comes out otherwise,"
        " the verdict turns.",
        default=(),
    )

    def read_as(self, reading: Reading) -> "Criterion":
        """Return the criterion with the measure and the definitions of another of its readings."""
        own = {name: getattr(reading, name) for name in ("measure", "wheelsets", "definition")}
        return self.model_copy(update={**own, "readings": ()})

    @property
    def in_valid_test(self) -> bool:
        """Whether, as a requirement, it stands in a valid test alone."""
        return self.stands == "in a valid test"

    @property
    def of_dry_stop(self) -> bool:
        """Whether the bounds are shares of the dry stop; values are then in % of it."""
        return isinstance(self.lower, DryBound) or isinstance(self.upper, DryBound)

    @property
    def needs_series(self) -> bool:
        """Whether only a series of stops can be judged by the criterion."""
        return self.scope == "series" or self.of_dry_stop

    @property
    def unit(self) -> str:
        """The unit value and bounds are printed in."""
        return "%" if self.of_dry_stop else self._measure.unit

    @property
    def meaning(self) -> str:
        """The measure in words."""
        return self._measure.meaning

    @property
    def observed_by(self) -> tuple[str, ...]:
        """The fields of the scenario's `measures` part that decide what was observed."""
        return () if self.scope == "series" else self.stop_measure.observed_by

    @property
    def corrected(self) -> tuple[str, ...]:
        """The conditions of a stop that the measure is corrected for."""
        return () if self.scope == "series" else self.stop_measure.corrected

    @property
    def aggregation(self) -> str:
        """Wheelsets that must keep the bounds, in words; empty for a measure of the stop."""
        if isinstance(self.wheelsets, AtLeast):
            return f"at least {self.wheelsets.at_least}"
        return self.wheelsets or ""

    def wheelsets_needed(self, count: int) -> int:
        """Return the number of `count` values that must keep the bounds (1 for a measure of the stop)."""
        if isinstance(self.wheelsets, AtLeast):
            return (count + 1) // 2 if self.wheelsets.at_least == "half" else self.wheelsets.at_least
        return count if self.wheelsets == "all" else 1

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield missing or crossed bounds, a wrong number of wheelsets, missing or unused definitions."""
        yield from repeated_requirements(self.requirements)
        if self.in_valid_test and self.layer != "requirement":
            message = f"criterion {quoted(self.id)} is one of {self.layer}: `stands` belongs to requirements"
            yield Inconsistency(("stands",), message, "leave it out")
        yield from self._bound_problems()
        yield from self._dry_bound_problems()
        if self.scope == "series":
            for name in sorted({"wheelsets", "definition", "readings"} & self.model_fields_set):
                message = f"{quoted(name)} belongs to a criterion of stops, this one has `scope: series`"
                yield Inconsistency((name,), message, "leave it out")
        else:
            yield from wheelsets_problems(self.measure, self.wheelsets)
            yield from definition_problems(self.measure, self.definition)
            yield from self._reading_problems()

    @property
    def _measure(self) -> Measure | SeriesMeasure:
        return MEASURES_OF[self.scope][self.measure]

    def speed_range(self, definition: Mapping[str, float]) -> str:
        """Return in words at which train speeds the criterion looks; empty: at all of them.

        `definition` holds the SI value of each of its definitions.
        """
        said = self.stop_measure.speed_range
        return said(definition) if said else ""

    @property
    def stop_measure(self) -> Measure:
        """The measure of a criterion of stops."""
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

    def _dry_bound_problems(self) -> Iterator[Inconsistency]:
        bounds = {"lower": self.lower, "upper": self.upper}
        shares = [name for name, bound in bounds.items() if isinstance(bound, DryBound)]
        if not shares:
            return
        if other := [name for name, bound in bounds.items() if bound is not None and name not in shares]:
            message = f"{quoted(other[0])} is no share of the dry stop, {quoted(shares[0])} is one"
            yield Inconsistency((other[0],), message, "write two criteria, or both bounds in the same way")
        if self.scope == "stop" and self.layer != "requirement":
            which = f"a criterion of {self.layer} cannot refer to the dry stop"
            message = f"{which}: which stops count decides that one"
            yield Inconsistency(("layer",), message, "write `layer: requirement`")
        # A dry value is one number of each stop, which results report.
        if self.scope == "series":
            has_dry_value = SERIES_MEASURES[self.measure].has_dry_value
            hint = "medians and worst values of single stops have one, such as `median_braking_distance`"
        else:
            has_dry_value = self.measure in WITH_DRY_VALUE
            hint = f"measures that have one: {', '.join(WITH_DRY_VALUE)}"
        if not has_dry_value:
            message = f"{quoted(self.measure)} has no value of the dry stop to refer to"
            yield Inconsistency((shares[0],), message, hint)

    def _reading_problems(self) -> Iterator[Inconsistency]:
        if self.readings and not self.reading:
            message = f"criterion {quoted(self.id)} has other readings, its own has no name"
            yield Inconsistency((), message, "write 'reading'")
        if self.readings and self.of_dry_stop:
            yield Inconsistency(
                ("readings",), "shares of the dry stop have no other readings", "leave them out"
            )
        seen = {self.reading}
        for index, reading in enumerate(self.readings):
            if reading.id in seen:
                message = f"a second reading is called {quoted(reading.id)}"
                yield Inconsistency(("readings", index, "id"), message)
            kind, own_kind = MEASURES[reading.measure].kind, self.stop_measure.kind
            if kind != own_kind:
                message = (
                    f"{quoted(reading.measure)} is a {kind}, but {quoted(self.measure)} a {own_kind}:"
                    " the same bounds cannot hold for both"
                )
                yield Inconsistency(("readings", index, "measure"), message)
            seen.add(reading.id)


class Criteria(Part):
    """A profile: criteria that belong together."""

    folder: ClassVar[str] = "criteria"

    schema_id: Literal["uictest/criteria/1"] = schema_field("uictest/criteria/1")
    # Not min_length: pydantic would also call a list too short all of whose criteria are wrong.
    criteria: tuple[Criterion, ...] = field(
        "The criteria, judged in this order.", json_schema_extra={"minItems": 1}
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
            named: list[tuple[tuple[str | int, ...], str]] = [
                (("source",), criterion.source),
                (("reading_source",), criterion.reading_source),
                *((("readings", k, "source"), each.source) for k, each in enumerate(criterion.readings)),
            ]
            for key, source in named:
                if source not in {SCENARIO_SOURCE, *self.sources}:
                    yield Inconsistency(
                        ("criteria", index, *key),
                        f"unknown source {quoted(source)}",
                        suggestion(source, self.sources) or "describe it under 'sources'",
                    )


def criteria_of_the_same_name(
    profiles: Iterable[Criteria], taken: Mapping[str, str] = MappingProxyType({})
) -> Iterator[Inconsistency]:
    """Yield criteria whose id another profile uses as well: their verdicts could not be distinguished.

    `taken` has the profiles of further criteria by the ids of these.
    """
    profile_of = dict(taken)
    for number, profile in enumerate(profiles):
        for index, criterion in enumerate(profile.criteria):
            if criterion.id in profile_of:
                yield Inconsistency(
                    ("criteria", number, "criteria", index, "id"),
                    f"criterion {quoted(criterion.id)} of profile {quoted(profile.name)} is in profile"
                    f" {quoted(profile_of[criterion.id])} as well",
                    "leave one profile out, or give the criterion another id",
                )
        profile_of |= {criterion.id: profile.name for criterion in profile.criteria}


RIG_CHECKS: Final = "uictest-rig"
"""Name of the profile that checks the rig in every simulated stop."""


@cache
def rig_checks() -> Criteria:
    """Return the profile of the library that checks the rig."""
    tree = read_library(Criteria.folder, RIG_CHECKS)
    profile: Criteria = validated(Criteria, plain(tree), tree)
    return profile.with_origin(RIG_CHECKS, profile)
