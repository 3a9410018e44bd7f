"""The head of every JSON document that we write: its schema and its kind of result."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final, Literal

RESULT: Final = "uictest/result/2"
MANIFEST: Final = "uictest/manifest/2"
_SHOWN: Final = 80
"""Characters that a reader is shown of an entry."""
Kind = Literal["run", "sweep", "validation", "comparison", "variants"]
_EARLIER: Final[Mapping[str, tuple[str, Kind]]] = {
    "uictest/result/1": (RESULT, "run"),
    "uictest/sweep-result/1": (RESULT, "sweep"),
    "uictest/validation-result/1": (RESULT, "validation"),
    "uictest/manifest/1": (MANIFEST, "run"),
    "uictest/sweep-manifest/1": (MANIFEST, "sweep"),
}
"""Schemas of 0.2, whose documents hold what those of today do -> how the head is written now."""


def head(schema: str, kind: Kind) -> dict[str, str]:
    """Return the first entries of a document."""
    return {"schema": schema, "kind": kind}


def is_of(document: object, schema: str, kind: Kind) -> bool:
    """Return whether a document that was read back has this schema and kind, or is what 0.2 wrote for it."""
    if not isinstance(document, Mapping):
        return False
    own = document.get("schema"), document.get("kind")
    return own == (schema, kind) or _EARLIER.get(str(own[0])) == (schema, kind)


def require(document: Mapping[str, Any], schema: str, kind: Kind) -> None:
    """Raise ValueError for a document of another schema or kind."""
    if not is_of(document, schema, kind):
        raise ValueError(f"expected schema {schema!r}, kind {kind!r}, found {head_of(document)}")


def head_of(document: Mapping[str, Any]) -> str:
    """Return the schema and kind of a document in words, shortened; `no schema` where it has none."""
    heads = (f"{name} {document[name]!r}"[:_SHOWN] for name in ("schema", "kind") if name in document)
    return ", ".join(heads) or "no schema"
