"""An instant of a stop: a time, the speed to which the train has slowed, or the distance that it has run."""

from typing import Annotated, Any, Final

from pydantic import PlainSerializer, PlainValidator, WithJsonSchema
from pydantic_core import PydanticCustomError

from uictest.core.units import KINDS
from uictest.plans.scenario.yaml import (
    QUANTITY_KEYWORD,
    Quantity,
    QuantityError,
    of_kind,
    parse_quantity,
    quoted,
    written,
)

_FIELDS: Final = (
    of_kind("time", at_least="0 s", at_most="3600 s"),
    of_kind("speed", above="0 km/h", at_most="600 km/h"),
    of_kind("length", at_least="0 m", at_most="100 km"),
)
_HINT: Final = "write a time, a speed or a distance: 3 s, 90 km/h, 120 m"
TIME, SPEED, DISTANCE = (field.kind.canonical for field in _FIELDS)
"""Unit of an instant that is a time, a speed or a distance."""


def _read(value: object) -> Quantity:
    if isinstance(value, Quantity):
        text, unit = value.text, value.unit
    else:
        text = getattr(value, "text", value if isinstance(value, str) else str(value))
        unit = _unit_of(text)
    for field in _FIELDS:
        if field.kind.canonical == unit:
            return field.validate(value)
    context = {"message": f"{quoted(text)} is no instant of a stop", "hint": _HINT}
    raise PydanticCustomError("moment", "{message}", context)


def _unit_of(text: str) -> str:
    for field in _FIELDS:
        try:
            parse_quantity(text, field.kind.name)
        except QuantityError:
            continue
        return field.kind.canonical
    return ""


_SCHEMA: Final[dict[str, Any]] = {
    "anyOf": [{QUANTITY_KEYWORD: name} for name in KINDS if name in ("time", "speed", "length")]
}

Moment = Annotated[Quantity, PlainValidator(_read), PlainSerializer(written), WithJsonSchema(_SCHEMA)]
"""A quantity whose unit says what it is."""
