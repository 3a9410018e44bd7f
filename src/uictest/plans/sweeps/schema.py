"""The JSON Schema (draft-07) of a sweep file, for editors."""

from __future__ import annotations

from typing import Any, Final

from uictest.plans.scenario import SCHEMA_DRAFT, SchemaGenerator, as_draft_07, quantity_definitions
from uictest.plans.sweeps.model import SweepFile

_KINDS: Final = ("acceleration", "share")
"""Kinds of the quantities that stand in a sweep file itself."""


def sweep_schema() -> dict[str, Any]:
    """Return the schema of ``uictest/sweep/1``, every field described."""
    schema = SweepFile.model_json_schema(
        by_alias=True, ref_template="#/definitions/{model}", schema_generator=SchemaGenerator
    )
    definitions = {**schema.pop("$defs"), **quantity_definitions(_KINDS)}
    schema = {"$schema": SCHEMA_DRAFT, **schema, "title": "uictest sweep", "definitions": definitions}
    draft: dict[str, Any] = as_draft_07(schema)
    return draft
