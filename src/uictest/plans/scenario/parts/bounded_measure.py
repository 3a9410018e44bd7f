"""The measure of a criterion, of a stop or of a series, and its bounds."""

from collections.abc import Mapping
from typing import Annotated, Any, Final, Literal

from pydantic import AfterValidator, PlainSerializer, PlainValidator, ValidationInfo, WithJsonSchema
from pydantic_core import PydanticCustomError

from uictest.core.measures import MEASURES, Measure
from uictest.core.series_measures import SERIES_MEASURES, SeriesMeasure
from uictest.core.units import KINDS
from uictest.plans.scenario.parts.dry_bound import dry_bound, is_dry_bound
from uictest.plans.scenario.yaml import Quantity, QuantityField, quoted, suggestion, written

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
