"""The JSON Schemas (draft-07) of scenarios and of parts, for editors."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any, Final

from pydantic import TypeAdapter
from pydantic.json_schema import GenerateJsonSchema

from uictest.core.units import KINDS
from uictest.plans.scenario.expansion import Vary
from uictest.plans.scenario.model import Scenario
from uictest.plans.scenario.parts.search import Search
from uictest.plans.scenario.resolution import PART_KEYS, PART_KINDS
from uictest.plans.scenario.train import TrainCar
from uictest.plans.scenario.yaml import QUANTITY_KEYWORD, Quantity, QuantityField, written

SCHEMA_DRAFT: Final = "http://json-schema.org/draft-07/schema#"
_DEFINITIONS: Final = "#/definitions/"


class SchemaGenerator(GenerateJsonSchema):
    """Generates schemas of files with quantities."""

    def encode_default(self, dft: Any) -> Any:
        """Defaults as a file would write them."""
        return written(dft) if isinstance(dft, Quantity) else super().encode_default(dft)


def json_schema() -> dict[str, Any]:
    """The schema of ``uictest/scenario/1``, every field described.

    It allows what the loader fills in: parts by default, and everything that a parent may give.
    """
    schema = _schema_2020_of(Scenario, "uictest scenario")
    for name, model in (("vary", Vary), ("search", Search)):
        of_model = _schema_2020_of(model, model.__name__)
        schema["definitions"] |= {**of_model.pop("definitions"), model.__name__: of_model}
        described = schema["properties"][name]["description"]
        of_section = [{"$ref": f"{_DEFINITIONS}{model.__name__}"}, {"type": "null"}]
        schema["properties"][name] = {"anyOf": of_section, "description": described}
    cars = _schema_2020_of(tuple[TrainCar, ...], "train")
    schema["definitions"]["TrainCar"] = cars["definitions"]["TrainCar"]
    train = schema["properties"]["train"]
    listed = {"type": "array", "minItems": 1, "items": {"$ref": f"{_DEFINITIONS}TrainCar"}}
    schema["properties"]["train"] = {**train, "anyOf": [listed, {"type": "null"}]}
    schema["properties"]["extends"] |= {"anyOf": [{"type": "string"}]}  # to extend nothing is no value
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
    draft: dict[str, Any] = as_draft_07(schema)
    return draft


def schema_of(model: Any, title: str) -> dict[str, Any]:
    """The schema of another kind of file that holds quantities and parts: a model, or one of several."""
    draft: dict[str, Any] = as_draft_07(_schema_2020_of(model, title))
    return draft


def _schema_2020_of(model: Any, title: str) -> dict[str, Any]:
    adapter = TypeAdapter[Any](model)
    schema = adapter.json_schema(ref_template=_DEFINITIONS + "{model}", schema_generator=SchemaGenerator)
    definitions = {**schema.pop("$defs", {}), **quantity_definitions(KINDS)}
    return {"$schema": SCHEMA_DRAFT, **schema, "title": title, "definitions": definitions}


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


PART_MODELS: Final = {PART_KINDS[key]: reference.model for key, reference in PART_KEYS.items()}
"""Kind of part, such as `brake` -> its model."""

_OF_FILES: Final = {
    "schema": "Kind and version of this file.",
    "extends": "The part that this one is based on: a name of the library or a relative path.",
}


def part_schema(kind: str) -> dict[str, Any]:
    """Return the schema of the files of a kind of part, a key of :data:`PART_MODELS`.

    A part may extend another and state what differs: of its keys only `schema` and `name` are required. What
    is missing in all, the loader says.
    """
    schema: dict[str, Any] = schema_of(PART_MODELS[kind], f"uictest {kind}")
    for described in _alternatives(schema):
        own = {"schema": {"const": f"uictest/{kind}/1"}, "extends": {"type": "string"}}
        of_files = {key: {"description": _OF_FILES[key], **form} for key, form in own.items()}
        described["properties"] = {**of_files, **described["properties"]}
        # A controller from outside may be named after its file.
        described["required"] = ["schema", *({"name"} & set(described.get("required", ())))]
    for definition in _merged_definitions(schema):
        definition.pop("required", None)
    schema["definitions"] = _used_definitions(schema)
    return schema


def _alternatives(schema: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """Yield the description of a part, or of each kind that it may have, as controllers do."""
    if "properties" in schema:
        yield schema
        return
    for reference in _referenced_names(schema.get("anyOf", ())):
        yield from _alternatives(schema["definitions"][reference])


def _merged_definitions(schema: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """Yield the definitions of mappings inside a part, which take over what its parent has in theirs.

    The items of a list are none of them: a list replaces that of the parent.
    """
    top = list(_alternatives(schema))
    seen: set[str] = set()
    waiting = [name for described in top for name in _referenced_names(described["properties"])]
    while waiting:
        name = waiting.pop()
        if name in seen or name.startswith("quantity-"):
            continue
        seen.add(name)
        definition = schema["definitions"][name]
        yield definition
        waiting += _referenced_names(definition.get("properties", {}))


def _used_definitions(schema: dict[str, Any]) -> dict[str, Any]:
    definitions = schema["definitions"]
    needed: dict[str, Any] = {}
    waiting = list(_referenced_names({**schema, "definitions": None}, items=True))
    while waiting:
        name = waiting.pop()
        if name not in needed:
            needed[name] = definitions[name]
            waiting += _referenced_names(needed[name], items=True)
    return {name: definitions[name] for name in definitions if name in needed}


def _referenced_names(node: Any, *, items: bool = False) -> Iterator[str]:
    if isinstance(node, dict):
        if isinstance(node.get("$ref"), str):
            yield node["$ref"].rpartition("/")[2]
        for key, inner in node.items():
            if items or key != "items":
                yield from _referenced_names(inner, items=items)
    elif isinstance(node, list | tuple):
        for inner in node:
            yield from _referenced_names(inner, items=items)
