"""The value of a parameter of a controller from outside: whatever JSON has."""

import math
from collections.abc import Mapping
from typing import Annotated, Any, Final

from pydantic import WithJsonSchema
from pydantic.functional_validators import PlainValidator
from pydantic_core import PydanticCustomError


def _parameter(value: object) -> Any:
    """Return a value of JSON; a number that remembers how it was written stays one."""
    if isinstance(value, float) and not math.isfinite(value):
        context = {"message": f"JSON has no number {value}", "hint": "write a finite number, or a text"}
        raise PydanticCustomError("parameter", "{message}", context)
    if isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, list | tuple):
        return tuple(_parameter(each) for each in value)
    if isinstance(value, Mapping):
        return {str(name): _parameter(each) for name, each in value.items()}
    hint = "leave the parameter out" if value is None else ""
    context = {"message": "expected a number, a text, true, false, a list or a mapping", "hint": hint}
    raise PydanticCustomError("parameter", "{message}", context)


_JSON: Final[dict[str, Any]] = {"type": ["number", "string", "boolean", "array", "object"]}
ParameterValue = Annotated[Any, PlainValidator(_parameter), WithJsonSchema(_JSON)]
