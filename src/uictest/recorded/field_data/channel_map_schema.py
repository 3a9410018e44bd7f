"""The JSON Schema (draft-07) of a channel map, for editors."""

from __future__ import annotations

from typing import Any

from uictest.plans.scenario import schema_of
from uictest.recorded.field_data.channel_map import ChannelMap


def channel_map_schema() -> dict[str, Any]:
    """Return the schema of ``uictest/channel-map/1`` as it is written: a channel may be a name or names."""
    schema: dict[str, Any] = schema_of(ChannelMap, "uictest channel-map")
    name = {"type": "string"}
    based_on = {"description": "A preset or a file that this map is based on.", **name}
    schema["properties"] = {**schema["properties"], "extends": based_on}
    schema["required"] = ["schema", "name"]
    channels = schema["properties"]["channels"]
    names = {"type": "array", "minItems": 1, "items": name}
    channels["additionalProperties"] = {"anyOf": [name, names, channels["additionalProperties"]]}
    return schema
