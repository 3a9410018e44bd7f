"""The JSON Schema (draft-07) of a series file, for editors."""

from __future__ import annotations

from typing import Any, Final

from uictest.plans.scenario import schema_of
from uictest.plans.series.model import SeriesFile

_STOPS: Final = {"anyOf": [{"type": "string"}, {"$ref": "#/definitions/Stops"}]}
_REQUIRED: Final = ("schema", "name", "dry", "wet")


def series_schema() -> dict[str, Any]:
    """Return the schema of ``uictest/series/1``, every field described."""
    schema: dict[str, Any] = schema_of(SeriesFile, "uictest series")
    schema["required"] = list(_REQUIRED)
    for role in ("dry", "wet"):
        listed = {"type": "array", "minItems": 1, "items": _STOPS}
        description = schema["properties"][role]["description"]
        schema["properties"][role] = {"description": description, "anyOf": [*_STOPS["anyOf"], listed]}
    return schema
