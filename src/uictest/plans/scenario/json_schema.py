"""The JSON Schema (draft-07) of a scenario file, for editors."""

from collections.abc import Iterable
from typing import Any, Final

from pydantic import BaseModel, TypeAdapter
from pydantic.json_schema import GenerateJsonSchema

from uictest.core.units import KINDS
from uictest.plans.scenario.model import Scenario
from uictest.plans.scenario.parts.vary import Vary
from uictest.plans.scenario.yaml import QUANTITY_KEYWORD, Quantity, QuantityField, written

SCHEMA_DRAFT: Final = "http://json-schema.org/draft-07/schema#"
_DEFINITIONS: Final = "#/definitions/"


class SchemaGenerator(GenerateJsonSchema):
    """Generates schemas of files with quantities."""

    def encode_default(self, dft: Any) -> Any:
        """Defaults as a file would write them."""
        return written(dft) if isinstance(dft, Quantity) else super().encode_default(dft)


def json_schema() -> dict[str, Any]:
    """The schema of ``uictest/scenario/1``, every field described."""
    schema = _schema_2020_of(TypeAdapter(Scenario), "uictest scenario")
    vary = _schema_2020_of(TypeAdapter(Vary), "Vary")
    schema["definitions"] |= {**vary.pop("definitions"), "Vary": vary}
    described = schema["properties"]["vary"]["description"]
    schema["properties"]["vary"] = {"$ref": f"{_DEFINITIONS}Vary", "description": described}
    _loosen(schema)
    draft: dict[str, Any] = as_draft_07(schema)
    return draft


def schema_of(model: type[BaseModel], title: str) -> dict[str, Any]:
    """The schema of another kind of file that holds quantities and parts."""
    return schema_of_type(TypeAdapter(model), title)


def schema_of_type(adapter: TypeAdapter[Any], title: str) -> dict[str, Any]:
    """The schema of a kind of file that is one of several models."""
    draft: dict[str, Any] = as_draft_07(_schema_2020_of(adapter, title))
    return draft


def _schema_2020_of(adapter: TypeAdapter[Any], title: str) -> dict[str, Any]:
    schema = adapter.json_schema(ref_template=_DEFINITIONS + "{model}", schema_generator=SchemaGenerator)
    definitions = {**schema.pop("$defs", {}), **quantity_definitions(KINDS)}
    return {"$schema": SCHEMA_DRAFT, **schema, "title": title, "definitions": definitions}


def _loosen(schema: dict[str, Any]) -> None:
    """Allow what the loader fills in: parts by default, and everything that a parent may give."""
    schema["required"] = ["schema", "name"]
    schema["anyOf"] = [{"required": ["extends"]}, {"required": ["initial_speed"]}]
    for section in ("Brake", "Rail", "Rig"):
        schema["definitions"][section].pop("required", None)
    for section in ("matrix", "zip"):
        schema["properties"][section]["anyOf"][0] = {
            "type": "object",
            "minProperties": 1,
            "additionalProperties": {"type": "array", "minItems": 1},
        }


def quantity_definitions(kinds: Iterable[str]) -> dict[str, Any]:
    """The definitions that a schema refers to for its quantities with a unit, which are of these kinds."""
    return {
        _definition_name(name): QuantityField(KINDS[name]).value_or_marked()
        for name in kinds
        if not KINDS[name].bare
    }


def _definition_name(kind: str) -> str:
    return "quantity-" + kind.replace(" ", "-")


def as_draft_07(node: Any) -> Any:
    """Rewrite what later drafts say differently, and leave out the titles that only repeat a key."""
    if isinstance(node, list):
        return [as_draft_07(item) for item in node]
    if not isinstance(node, dict):
        return node
    if QUANTITY_KEYWORD in node:
        rest = {key: value for key, value in node.items() if key not in (QUANTITY_KEYWORD, "title")}
        return {**rest, "allOf": [{"$ref": _DEFINITIONS + _definition_name(node[QUANTITY_KEYWORD])}]}
    rewritten = {key: as_draft_07(value) for key, value in node.items() if key != "discriminator"}
    if "oneOf" in rewritten:
        # An inline mapping in part may fit several models; which one it is, its parent says.
        rewritten["anyOf"] = rewritten.pop("oneOf")
    if "prefixItems" in rewritten:
        rewritten["items"] = rewritten.pop("prefixItems")
    if "$ref" in rewritten and len(rewritten) > 1:
        rewritten["allOf"] = [{"$ref": rewritten.pop("$ref")}]
    if isinstance(rewritten.get("title"), str) and "properties" not in rewritten:
        del rewritten["title"]
    return rewritten
