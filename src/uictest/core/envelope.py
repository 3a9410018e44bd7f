"""The head of every JSON document that we write: its schema and its kind of result."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final, Literal

RESULT: Final = "uictest/result/2"
MANIFEST: Final = "uictest/manifest/2"
_SHOWN: Final = 80
"""Characters that a reader is shown of an entry."""
Kind = Literal["run", "sweep", "validation", "comparison", "variants"]
OLD: Final = "written by uictest 0.2 or older: run it again"
_OF_OLD: Final = frozenset(
    {
        "uictest/result/1",
        "uictest/sweep-result/1",
        "uictest/validation-result/1",
        "uictest/manifest/1",
        "uictest/sweep-manifest/1",
    }
)
"""Schemas that are not read any more."""


def head(schema: str, kind: Kind) -> dict[str, str]:
    """Return the first entries of a document."""
    return {"schema": schema, "kind": kind}


def is_of(document: object, schema: str, kind: Kind) -> bool:
    """Return whether a document that was read back has this schema and kind."""
    return isinstance(document, Mapping) and (document.get("schema"), document.get("kind")) == (schema, kind)


def require(document: Mapping[str, Any], schema: str, kind: Kind) -> None:
    """Raise ValueError for a document of another schema or kind."""
    if not is_of(document, schema, kind):
        raise ValueError(f"expected schema {schema!r}, kind {kind!r}, found {head_of(document)}")


def head_of(document: Mapping[str, Any]) -> str:
    """Return the schema and kind of a document in words, shortened; `no schema` where it has none.

    Of a document of uictest 0.2 or older it says that, and what to do.
    """
    heads = (f"{name} {document[name]!r}"[:_SHOWN] for name in ("schema", "kind") if name in document)
    shown = ", ".join(heads) or "no schema"
    return f"{shown}, {OLD}" if is_old(document) else shown


def is_old(document: Mapping[str, Any]) -> bool:
    """Return whether a document was written by uictest 0.2 or older."""
    return str(document.get("schema")) in _OF_OLD
