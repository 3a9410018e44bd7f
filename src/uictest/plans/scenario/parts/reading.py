"""How the words of a criterion are read, and the stops that it applies to."""

from collections.abc import Iterator
from typing import Annotated, ClassVar, Literal, get_args

from pydantic import Field, model_validator

from uictest.core.identity_cache import once_per_object
from uictest.core.measures import MEASURES, SLIDE_CLASS, SLOW_SHARE_CLASS
from uictest.core.units import in_unit
from uictest.plans.scenario.parts.measures import StopMeasureName
from uictest.plans.scenario.yaml import SCENARIO_SOURCE, Inconsistency, Model, Quantity, quoted
from uictest.plans.scenario.yaml.quantity_field import field, of_kind, optional, quantity

_Duration = Annotated[Quantity, of_kind("time", "> 0 s .. 10 s")]
_Cutoff = Annotated[Quantity, of_kind("speed", "0 km/h .. 200 km/h")]
_SlidingBelow = Annotated[Quantity, of_kind("share", "85 % .. 95 %")]
_EndSpeed = Annotated[Quantity, of_kind("speed", "10 km/h .. 100 km/h")]


class RangedDefinition(Model):
    """One definition of a criterion: the value used, and the range of values that the words allow.

    `unit` is what it is printed in, `step` the size (SI) of the classes it comes in, None where it is
    continuous. `supposed` is the clause that supposes another value, which stands for its braces.
    """

    unit: ClassVar[str]
    supposed: ClassVar[str]
    step: ClassVar[float | None]

    value: Quantity
    range: tuple[Quantity, Quantity]
    source: str = field("A key of the part's `sources`, for value and range.", default=SCENARIO_SOURCE)

    @model_validator(mode="before")
    @classmethod
    def _with_its_source(cls, definition: object) -> object:
        """Give the source that a definition names to each of its numbers."""
        if not (isinstance(definition, dict) and isinstance(definition.get("source"), str)):
            return definition
        marked, source = {**definition}, definition["source"]
        if "value" in definition:
            marked["value"] = _with_source(definition["value"], source)
        if isinstance(definition.get("range"), list | tuple):
            marked["range"] = tuple(_with_source(end, source) for end in definition["range"])
        return marked

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield every number between two classes, then a range that falls or does not hold the value."""
        lower, upper = self.range
        if self.step is not None:
            whole = round(in_unit(self.step, self.unit), 6)
            for key, number in ((("value",), self.value), (("range", 0), lower), (("range", 1), upper)):
                if round(in_unit(number, self.unit), 6) % whole:
                    message = f"{number.text} is no multiple of {whole:g} {self.unit}"
                    yield Inconsistency(key, message, "measures are kept in such classes")
        if lower > upper:
            yield Inconsistency(("range",), f"the range falls from {lower.text} to {upper.text}")
        elif not lower <= self.value <= upper:
            message = f"{self.value.text} is outside its own range of {lower.text} to {upper.text}"
            yield Inconsistency(("value",), message)


def _with_source(number: object, source: str) -> object:
    return number if isinstance(number, dict | Quantity) else {"value": number, "source": source}


class FirstPhaseDuration(RangedDefinition):
    """How long the first phase of braking lasts, from the first sliding of any wheelset."""

    unit: ClassVar[str] = "s"
    supposed: ClassVar[str] = "the first phase of braking lasted {}"
    step: ClassVar[float | None] = None

    value: _Duration = field("Duration used.")
    range: tuple[_Duration, _Duration] = field("Shortest and longest duration the words could mean.")


class LowSpeedCutoff(RangedDefinition):
    """The train speed down to which slides count: a multiple of 10 km/h, as slides are kept in classes."""

    unit: ClassVar[str] = "km/h"
    supposed: ClassVar[str] = "slides counted down to {}"
    step: ClassVar[float | None] = SLIDE_CLASS

    value: _Cutoff = field("Cut-off used.")
    range: tuple[_Cutoff, _Cutoff] = field("Lowest and highest cut-off the words could mean.")


class SlidingBelow(RangedDefinition):
    """The share of the train's speed below which a wheelset slides: 85, 90 or 95 %."""

    unit: ClassVar[str] = "%"
    supposed: ClassVar[str] = "sliding counted below {} of the train's speed"
    step: ClassVar[float | None] = SLOW_SHARE_CLASS

    value: _SlidingBelow = field("Share used.")
    range: tuple[_SlidingBelow, _SlidingBelow] = field("Lowest and highest share the words could mean.")


class EndSpeed(RangedDefinition):
    """The train speed that ends the time in which sliding counts: a multiple of 10 km/h, at most 100 km/h."""

    unit: ClassVar[str] = "km/h"
    supposed: ClassVar[str] = "the time in which sliding counts ended at {}"
    step: ClassVar[float | None] = SLIDE_CLASS

    value: _EndSpeed = field("Speed used.")
    range: tuple[_EndSpeed, _EndSpeed] = field("Lowest and highest speed the words could mean.")


class Definition(Model):
    """The definitions that a criterion depends on; each measure says which it needs."""

    first_phase_duration: FirstPhaseDuration | None = optional(
        "First phase of braking, counted from the first sliding."
    )
    low_speed_cutoff: LowSpeedCutoff | None = optional("Speed down to which slides count.")
    sliding_below: SlidingBelow | None = optional("Share of the train's speed below which a wheelset slides.")
    end_speed: EndSpeed | None = optional("Speed that ends the time in which sliding counts.")

    def parameters(self) -> dict[str, RangedDefinition]:
        """Return the definitions that are given, by name."""
        return {name: value for name, value in self if isinstance(value, RangedDefinition)}

    @once_per_object
    def stated(self) -> dict[str, float]:
        """Return the SI value used of each definition that is given."""
        return {name: float(parameter.value) for name, parameter in self.parameters().items()}


def supposed_definition(name: str) -> str:
    """Return the clause that supposes another value of a definition; of an unknown one it has its name."""
    known = Definition.model_fields.get(name)
    if known is None:
        return f"{name} were {{}}"
    kind: type[RangedDefinition] = get_args(known.annotation)[0]
    return kind.supposed


ID = r"^[a-z0-9][a-z0-9._-]{0,99}$"
WHEELSET_COUNT = 4
"""Wheelsets of the car."""


class AtLeast(Model):
    """How many wheelsets must keep the bound."""

    at_least: Literal["half"] | Annotated[int, Field(ge=1, le=WHEELSET_COUNT, strict=True)] = field(
        "A number of wheelsets, or `half` of them (rounded up)."
    )


WheelsetsThatKeep = Literal["all", "any"] | AtLeast | None


class Reading(Model):
    """Another measure that the words of a criterion may mean, held against the same bounds.

    It never changes the status of the criterion: where it comes out otherwise, the verdict turns.
    """

    id: str = field("Name of the reading in every report.", pattern=ID)
    source: str = field(
        "A key of the part's `sources`: where the reading comes from.", default=SCENARIO_SOURCE
    )
    measure: StopMeasureName = field("The measure that is read.")
    wheelsets: WheelsetsThatKeep = optional(
        "For a measure of wheelsets: how many of them must keep the bounds."
    )
    definition: Definition = field("The definitions that the measure needs.", default=Definition())

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
    """An initial speed with the tolerance within which a stop is judged; distances are corrected to it."""

    value: Quantity = quantity("Nominal initial speed.", "speed", "> 0 km/h .. 600 km/h")
    tolerance: Quantity = quantity("Largest deviation either way.", "speed", "0 km/h .. 600 km/h")


class NominalShare(Model):
    """A brake command with its tolerance."""

    value: Quantity = quantity("Nominal command.", "share", "> 0 % .. 100 %")
    tolerance: Quantity = quantity("Largest deviation either way.", "share", "0 % .. 100 %")


class NominalGradient(Model):
    """A gradient with its tolerance."""

    value: Quantity = quantity(
        "Nominal gradient, positive uphill.", "gradient", "-60 permille .. 60 permille"
    )
    tolerance: Quantity = quantity("Largest deviation either way.", "gradient", "0 permille .. 120 permille")


Nominal = NominalSpeed | NominalShare | NominalGradient


class Applicability(Model):
    """Conditions of a stop under which a criterion applies; a condition that is not named is not checked."""

    rail_condition: tuple[str, ...] | None = optional("Names of rail conditions, e.g. wet.")
    rail_condition_other_than: tuple[str, ...] | None = optional(
        "Names of rail conditions that the criterion is not for, e.g. dry."
    )
    rail_cleaned: bool | None = optional(
        "Whether sliding cleans the rail; a recorded rail answers as it does and meets either.", strict=True
    )
    wsp: tuple[Literal["active", "bypassed"], ...] | None = optional("States of the WSP.")
    brake_position: tuple[str, ...] | None = optional("Brake positions, e.g. R.")
    topology: tuple[Literal["one-caliper", "four-caliper"], ...] | None = optional("Topologies of the rig.")
    initial_speed: NominalSpeed | None = optional("Initial speed; distances are corrected to it.")
    command: NominalShare | None = optional("Share of the full service command.")
    gradient: NominalGradient | None = optional("Gradient of the track.")
