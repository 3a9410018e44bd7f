"""What a criterion bounds: a measure, the definitions that it needs, and other readings of the same words."""

import re
from collections.abc import Iterator, Mapping
from functools import cached_property
from typing import Annotated, Any, ClassVar, Final, Literal, get_args

from pydantic import (
    AfterValidator,
    Field,
    PlainSerializer,
    PlainValidator,
    ValidationInfo,
    WithJsonSchema,
    model_validator,
)

from uictest.core.measures import MEASURES, SLIDE_CLASS, SLOW_SHARE_CLASS, Measure
from uictest.core.series_measures import SERIES_MEASURES, SeriesMeasure
from uictest.core.units import KINDS, in_unit
from uictest.plans.scenario.yaml import (
    NAME_PATTERN,
    SCENARIO_SOURCE,
    Inconsistency,
    Model,
    Part,
    Quantity,
    QuantityError,
    QuantityField,
    field,
    of_kind,
    optional,
    parse_quantity,
    quantity,
    quoted,
    refused,
    schema_field,
    suggestion,
    written,
)

Speed = Annotated[Quantity, of_kind("speed", "0.001 km/h .. 100 km/h")]
Share = Annotated[Quantity, of_kind("share", "0.001 % .. 100 %")]


class MeasureDefinitions(Part):
    """The definitions of the measures of every stop, simulated or recorded."""

    folder: ClassVar[str] = "measures"

    schema_id: Literal["uictest/measures/1"] = schema_field("uictest/measures/1")
    sliding_slide: Share = field("Relative slide from which a wheelset counts as sliding.")
    sliding_slip: Speed = field("Slip speed that a sliding wheelset must have as well.")
    locked_speed: Speed = field("Wheel speed below which a wheelset counts as locked.")
    moving_speed: Speed = field("Train speed above which slides, locks and decelerations are observed.")
    deceleration_filter: Quantity = quantity(
        "Time constant of the low-pass of the deceleration.", "time", "0 s .. 10 s"
    )
    developed_time: Quantity = quantity(
        "Time after the command from which the smallest deceleration is kept.", "time", "0 s .. 60 s"
    )
    rising_share: Share = field(
        "Share of the commanded pressure at which the brake-line pressure counts as rising."
    )
    developed_share: Share = field("Share of the commanded pressure at which the brake counts as built up.")
    reduced_share: Share = field(
        "Share of the brake-line pressure below which a tank counts as held down by the WSP."
    )
    released_share: Quantity = quantity(
        "Share of the largest clamping force below which a wheelset is without brake force.",
        "share",
        "0 % .. 100 %",
        default="20 %",
    )
    monitored_speed: Quantity = quantity(
        "A of A + B v: difference from the train's speed v beyond which a wheelset must be reported.",
        "speed",
        "0 km/h .. 300 km/h",
        default="50 km/h",
    )
    monitored_share: Quantity = quantity("B of A + B v.", "share", "0 % .. 100 %", default="30 %")

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield a brake that is built up before its pressure rises."""
        yield from super().inconsistencies()
        if self.developed_share <= self.rising_share:
            yield Inconsistency(
                ("developed_share",),
                f"{self.developed_share.text} is not above rising_share = {self.rising_share.text}",
                "the brake is built up after its pressure has begun to rise",
            )


_MENTION: Final = re.compile(r"(?i)\bdry\b")
_WRITTEN: Final = re.compile(r"(?P<share>.*\S)\s+of\s+the\s+dry\s+stop\s*", re.DOTALL)
_EXAMPLE: Final = "write such as `125 % of the dry stop`"


class DryBound(Quantity):
    """A share (1 = 100 %) of the same figure of the dry stop, the mean over the dry stops of that speed."""

    __slots__ = ()


def is_dry_bound(value: object) -> bool:
    """Return whether what a file gives as a bound is meant as a share of the dry stop."""
    if isinstance(value, dict):
        value = value.get("value")
    return isinstance(value, DryBound) or (isinstance(value, str) and bool(_MENTION.search(value)))


def dry_bound(value: Any) -> DryBound:
    """Return the bound. Raises an error of validation with a hint where it is written in another way."""
    if isinstance(value, DryBound):
        return value
    if isinstance(value, dict):
        return _marked(value)
    match = _WRITTEN.fullmatch(str(value))
    if match is None:
        raise refused(f"{quoted(str(value))} is no share of the dry stop", _EXAMPLE)
    try:
        share = parse_quantity(match["share"], "share")
    except QuantityError as error:
        raise refused(error.message, f"{error.hint}; {_EXAMPLE}" if error.hint else _EXAMPLE) from None
    if share <= 0.0:
        raise refused(f"a bound of {quoted(str(value))} is not above zero", _EXAMPLE)
    return DryBound(float(share), " ".join(str(value).split()), share.unit)


def _marked(value: dict[str, Any]) -> DryBound:
    source = value.get("source")
    if set(value) != {"value", "source"} or not isinstance(source, str):
        raise refused("expected a share of the dry stop, found a mapping", "give it a 'value' and a 'source'")
    bare = dry_bound(value["value"])
    return DryBound(float(bare), bare.text, bare.unit, source)


WITH_DRY_VALUE: Final = tuple(
    name for name, measure in MEASURES.items() if measure.column and not measure.of_wheelsets
)
"""Measures of stops that are one number in results, so that a wet stop has a dry one to refer to."""
Scope = Literal["stop", "series"]
MEASURES_OF: Final[Mapping[Scope, Mapping[str, Measure | SeriesMeasure]]] = {
    "stop": MEASURES,
    "series": SERIES_MEASURES,
}


def _known_measure(name: str, info: ValidationInfo) -> str:
    scope: Scope = info.data.get("scope", "stop")
    other: Scope = "series" if scope == "stop" else "stop"
    if name in MEASURES_OF[scope]:
        return name
    if name in MEASURES_OF[other]:
        message = f"{quoted(name)} is a measure of a {other}, not of a {scope}"
        raise refused(message, f"write `scope: {other}`")
    raise refused(f"unknown measure {quoted(name)}", suggestion(name, MEASURES_OF[scope]))


def _of_the_measure(bound: object, info: ValidationInfo) -> object:
    if is_dry_bound(bound):
        return dry_bound(bound)
    # Without a valid measure its kind is not known; the model is rejected for that already.
    measure = MEASURES_OF[info.data.get("scope", "stop")].get(info.data.get("measure", ""))
    return bound if measure is None else QuantityField(KINDS[measure.kind]).validate(bound)


MeasureName = Annotated[
    str,
    AfterValidator(_known_measure),
    WithJsonSchema({"type": "string", "enum": sorted({*MEASURES, *SERIES_MEASURES})}),
]
StopMeasureName = Annotated[
    str, AfterValidator(_known_measure), WithJsonSchema({"type": "string", "enum": sorted(MEASURES)})
]
"""A measure of stops: of a model without a scope."""
Bound = Annotated[
    Quantity,
    PlainValidator(_of_the_measure),
    PlainSerializer(written),
    WithJsonSchema({"type": ["string", "number", "object"]}),
]
"""A quantity of whatever kind the measure of the criterion is, or a share of the dry stop."""
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

    @cached_property
    def stated(self) -> dict[str, float]:
        """The SI value used of each definition that is given."""
        return {name: float(parameter.value) for name, parameter in self.parameters().items()}


def supposed_definition(name: str) -> str:
    """Return the clause that supposes another value of a definition; of an unknown one it has its name."""
    known = Definition.model_fields.get(name)
    if known is None:
        return f"{name} were {{}}"
    kind: type[RangedDefinition] = get_args(known.annotation)[0]
    return kind.supposed


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

    id: str = field("Name of the reading in every report.", pattern=NAME_PATTERN)
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
