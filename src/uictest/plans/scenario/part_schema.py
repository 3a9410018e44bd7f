"""The JSON Schema (draft-07) of files of parts, for editors."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final

from pydantic import TypeAdapter

from uictest.plans.scenario.json_schema import schema_of_type
from uictest.plans.scenario.part_keys import PART_KEYS, PART_KINDS

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
    schema: dict[str, Any] = schema_of_type(TypeAdapter(PART_MODELS[kind]), f"uictest {kind}")
    for described in _alternatives(schema):
        described["properties"] = {**_keys_of_files(kind), **described["properties"]}
        # A controller from outside may be named after its file.
        described["required"] = ["schema", *({"name"} & set(described.get("required", ())))]
    for definition in _merged(schema):
        definition.pop("required", None)
    schema["definitions"] = _used(schema)
    return schema


def _keys_of_files(kind: str) -> dict[str, Any]:
    own = {"schema": {"const": f"uictest/{kind}/1"}, "extends": {"type": "string"}}
    return {key: {"description": _OF_FILES[key], **form} for key, form in own.items()}


def _alternatives(schema: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """Yield the description of a part, or of each kind that it may have, as controllers do."""
    if "properties" in schema:
        yield schema
        return
    for reference in _references(schema.get("anyOf", ())):
        yield from _alternatives(schema["definitions"][reference])


def _merged(schema: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """Yield the definitions of mappings inside a part, which take over what its parent has in theirs.

    The items of a list are none of them: a list replaces that of the parent.
    """
    top = list(_alternatives(schema))
    seen: set[str] = set()
    waiting = [name for described in top for name in _references(described["properties"])]
    while waiting:
        name = waiting.pop()
        if name in seen or name.startswith("quantity-"):
            continue
        seen.add(name)
        definition = schema["definitions"][name]
        yield definition
        waiting += _references(definition.get("properties", {}))


def _used(schema: dict[str, Any]) -> dict[str, Any]:
    """Return the definitions that a schema needs: it lists those of every kind of quantity."""
    definitions = schema["definitions"]
    needed: dict[str, Any] = {}
    waiting = list(_references({**schema, "definitions": None}, items=True))
    while waiting:
        name = waiting.pop()
        if name not in needed:
            needed[name] = definitions[name]
            waiting += _references(needed[name], items=True)
    return {name: definitions[name] for name in definitions if name in needed}


def _references(node: Any, *, items: bool = False) -> Iterator[str]:
    """Yield the definitions that a schema refers to; those of the items of lists only if asked for."""
    if isinstance(node, dict):
        if isinstance(node.get("$ref"), str):
            yield node["$ref"].rpartition("/")[2]
        for key, inner in node.items():
            if items or key != "items":
                yield from _references(inner, items=items)
    elif isinstance(node, list | tuple):
        for inner in node:
            yield from _references(inner, items=items)
