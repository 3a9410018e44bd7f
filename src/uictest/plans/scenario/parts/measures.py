"""Definitions of the measures, the measure of a criterion and its bounds, also as shares of the dry stop."""

import re
from collections.abc import Iterator, Mapping
from typing import Annotated, Any, ClassVar, Final, Literal

from pydantic import AfterValidator, PlainSerializer, PlainValidator, ValidationInfo, WithJsonSchema
from pydantic_core import PydanticCustomError

from uictest.core.measures import MEASURES, Measure
from uictest.core.series_measures import SERIES_MEASURES, SeriesMeasure
from uictest.core.units import KINDS
from uictest.plans.scenario.yaml import (
    Inconsistency,
    Part,
    Quantity,
    QuantityError,
    QuantityField,
    parse_quantity,
    quoted,
    suggestion,
    written,
)
from uictest.plans.scenario.yaml.quantity_field import field, of_kind, quantity, schema_field

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
    monitored_share: Quantity = quantity(
        "B of A + B v.",
        "share",
        "0 % .. 100 %",
        default="30 %",
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
    """Return the bound. Raises PydanticCustomError with a hint where it is written in another way."""
    if isinstance(value, DryBound):
        return value
    if isinstance(value, dict):
        return _marked(value)
    match = _WRITTEN.fullmatch(str(value))
    if match is None:
        raise _error(f"{quoted(str(value))} is no share of the dry stop", _EXAMPLE)
    try:
        share = parse_quantity(match["share"], "share")
    except QuantityError as error:
        raise _error(error.message, f"{error.hint}; {_EXAMPLE}" if error.hint else _EXAMPLE) from None
    if share <= 0.0:
        raise _error(f"a bound of {quoted(str(value))} is not above zero", _EXAMPLE)
    return DryBound(float(share), " ".join(str(value).split()), share.unit)


def _marked(value: dict[str, Any]) -> DryBound:
    source = value.get("source")
    if set(value) != {"value", "source"} or not isinstance(source, str):
        raise _error("expected a share of the dry stop, found a mapping", "give it a 'value' and a 'source'")
    bare = dry_bound(value["value"])
    return DryBound(float(bare), bare.text, bare.unit, source)


def _error(message: str, hint: str) -> PydanticCustomError:
    return PydanticCustomError("quantity", "{message}", {"message": message, "hint": hint})


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
    if name not in MEASURES_OF[scope]:
        raise PydanticCustomError("measure", "{message}", _unknown_measure(name, scope))
    return name


def _unknown_measure(name: str, scope: Scope) -> dict[str, Any]:
    other: Scope = "series" if scope == "stop" else "stop"
    if name in MEASURES_OF[other]:
        message = f"{quoted(name)} is a measure of a {other}, not of a {scope}"
        return {"message": message, "hint": f"write `scope: {other}`"}
    hint = suggestion(name, MEASURES_OF[scope])
    return {"message": f"unknown measure {quoted(name)}", "hint": hint}


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
    str,
    AfterValidator(_known_measure),
    WithJsonSchema({"type": "string", "enum": sorted(MEASURES)}),
]
"""A measure of stops: of a model without a scope."""

Bound = Annotated[
    Quantity,
    PlainValidator(_of_the_measure),
    PlainSerializer(written),
    WithJsonSchema({"type": ["string", "number", "object"]}),
]
"""A quantity of whatever kind the measure of the criterion is, or a share of the dry stop."""
