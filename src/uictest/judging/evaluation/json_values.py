"""Data as JSON can hold them, and what results report of a stop and of its wheelsets."""

from __future__ import annotations

import math
import sys
from collections.abc import Collection, Mapping
from functools import cached_property, partial
from typing import Annotated, Any, Literal, TypeVar

from pydantic import (
    BeforeValidator,
    ConfigDict,
    GetCoreSchemaHandler,
    PlainSerializer,
    PlainValidator,
    SerializerFunctionWrapHandler,
    TypeAdapter,
    ValidationError,
    ValidationInfo,
    WrapSerializer,
)
from pydantic_core import CoreSchema, core_schema

from uictest.core.measures import STOP_COLUMNS, WHEELSET_COLUMNS

_Content = TypeVar("_Content")


def json_form(value: Any) -> Any:
    """Return a value made of dicts, lists, tuples, text and numbers with NaN and infinity as None."""
    if isinstance(value, Mapping):
        return {str(key): json_form(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [json_form(item) for item in value]
    return finite_or_none(value)


def finite_or_none(value: Any) -> Any:
    """Return a number as JSON can hold it, None for NaN and infinity; anything else unchanged."""
    if isinstance(value, float):
        # float(): a subclass (a quantity, a numpy number) would otherwise print in its own way.
        return float(value) if math.isfinite(value) else None
    return value


def nan_for_none(value: object) -> object:
    """Return NaN for a null of JSON; anything else unchanged."""
    return math.nan if value is None else value


Number = Annotated[float, BeforeValidator(nan_for_none), PlainSerializer(finite_or_none)]
"""A number whose NaN and infinity are null in JSON; null reads as NaN."""

OptionalNumber = Annotated[float | None, PlainSerializer(finite_or_none)]
"""A number that may be absent: NaN, infinity and None are null in JSON; null reads as None."""


def absent_if_empty(*names: str) -> WrapSerializer:
    """Return the serializer of a form that has these fields only where there is something in them."""

    def filled(content: object, write: SerializerFunctionWrapHandler) -> dict[str, Any]:
        form: dict[str, Any] = write(content)
        return {name: value for name, value in form.items() if value or name not in names}

    return WrapSerializer(filled)


def required(*names: str) -> BeforeValidator:
    """Return the validator of a form that always holds these fields, whatever defaults they have."""

    def complete(content: object) -> object:
        missing = [name for name in names if isinstance(content, Mapping) and name not in content]
        if missing:
            raise ValueError(f"{missing[0]!r} is missing")
        return content

    return BeforeValidator(complete)


def ignored(*names: str) -> BeforeValidator:
    """Return the validator of a form that has these fields for readers alone: they follow from the others."""

    def without(content: object) -> object:
        if isinstance(content, Mapping):
            return {name: value for name, value in content.items() if name not in names}
        return content

    return BeforeValidator(without)


class BuiltWhenUsed:
    """Annotation of what most documents lack: pydantic builds its form when one has it, not before."""

    def __init__(self, form: Any) -> None:
        self._form = form

    @cached_property
    def _adapter(self) -> TypeAdapter[Any]:
        return TypeAdapter(self._form | None, config=ConfigDict(extra="forbid"))

    def _read(self, content: object, info: ValidationInfo) -> Any:
        return self._adapter.validate_python(content, context=info.context)

    def _write(self, value: object) -> Any:
        return to_json_form(self._adapter, value)

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.with_info_plain_validator_function(
            self._read, serialization=core_schema.plain_serializer_function_ser_schema(self._write)
        )


def from_json_form(
    adapter: TypeAdapter[_Content], content: object, *, place: str = "", context: object = None
) -> _Content:
    """Return the data whose JSON form, as the adapter writes it, is `content`.

    `place` is where the content stands in its document. Raises ValueError that names the first place where
    the content is not of that form.
    """
    try:
        return adapter.validate_python(content, context=context)
    except ValidationError as error:
        first = error.errors(include_url=False, include_context=False, include_input=False)[0]
        where = ".".join(filter(None, (place, *map(str, first["loc"]))))
        what = first["msg"].removeprefix("Value error, ")
        raise ValueError(f"{where}: {what}" if where else what) from error


def to_json_form(adapter: TypeAdapter[Any], value: object) -> Any:
    """Return the JSON form of a value: dicts, lists, text, finite numbers and None."""
    return adapter.dump_python(value, mode="json", by_alias=True)


Outcome = Literal["pass", "fail", "invalid", "inconclusive", "error", "skipped"]


def _numbers_by_column(content: object, known: Collection[str]) -> dict[str, float]:
    """Return the numbers of a document in these columns; NaN for null and for a column that it lacks.

    A measure that was added to the program is not available in the documents of before.
    """
    if not isinstance(content, Mapping) or not content or not set(content) <= set(known):
        raise ValueError(f"Input should have the columns {', '.join(known)}")
    if not all(value is None or _is_number(value) for value in content.values()):
        raise ValueError("Input should hold numbers only")
    return {name: math.nan if (value := content.get(name)) is None else value for name in known}


def _is_number(value: object) -> bool:
    # JSON writes whole numbers of any length; one beyond the largest float is not a measure.
    return type(value) is float or (type(value) is int and abs(value) <= sys.float_info.max)


_finite = PlainSerializer(json_form)
CaseMeasures = Annotated[
    Mapping[str, float], PlainValidator(partial(_numbers_by_column, known=STOP_COLUMNS)), _finite
]
"""What a result reports of a stop: a key of :data:`.STOP_COLUMNS` -> number, NaN: not reached."""

CaseWheelsetMeasures = Annotated[
    Mapping[str, float], PlainValidator(partial(_numbers_by_column, known=WHEELSET_COLUMNS)), _finite
]
"""What it reports of one wheelset: a key of :data:`.WHEELSET_COLUMNS` -> number, NaN: not reached."""
