"""The JSON Schema (draft-07) of a sweep file, for editors."""

from __future__ import annotations

from typing import Any

from uictest.scenario import SCHEMA_DRAFT, as_draft_07
from uictest.sweep.plan.model import SweepFile


def sweep_schema() -> dict[str, Any]:
    """Return the schema of ``uictest/sweep/1``, every field described."""
    schema = SweepFile.model_json_schema(by_alias=True, ref_template="#/definitions/{model}")
    definitions = schema.pop("$defs")
    schema = {"$schema": SCHEMA_DRAFT, **schema, "title": "uictest sweep", "definitions": definitions}
    draft: dict[str, Any] = as_draft_07(schema)
    return draft
