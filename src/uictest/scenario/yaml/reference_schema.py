"""How references to parts look to an editor: a name, a path or a mapping."""

from dataclasses import dataclass
from typing import Any

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import CoreSchema


@dataclass(frozen=True, slots=True)
class PartReference:
    """Marks a field that refers to a part; ``default`` is the library name taken when the key is left out.

    Where ``several``, a list of references is accepted as well.
    """

    model: Any
    default: str
    several: bool = False

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return handler(source)

    def __get_pydantic_json_schema__(self, core: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        if not self.several:
            return {"default": self.default, "anyOf": [_NAME, handler(core)]}
        inline = handler(core)["items"]
        listed = {"type": "array", "minItems": 1, "items": {"anyOf": [_NAME, inline]}}
        return {"default": self.default, "anyOf": [_NAME, inline, listed]}


_NAME = {
    "type": "string",
    "minLength": 1,
    "description": "A library name, or a relative path ending in .yaml.",
}
