"""The result document, schema uictest/result/1."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from typing import Any

from uictest.evaluation.json_form import json_form
from uictest.evaluation.parameters import EffectivePart, parts_table
from uictest.evaluation.result import CaseResult

SCHEMA = "uictest/result/1"


def result_document(results: Iterable[CaseResult], **header: Any) -> dict[str, Any]:
    """Return `{"schema": ..., **header, "parts": {...}, "cases": [...]}`, with NaN and infinity as None.

    Cases name their parts by ids: a part that many cases share is there once.
    """
    results = list(results)
    return {
        "schema": SCHEMA,
        **json_form(header),
        "parts": parts_document(result.parts for result in results),
        "cases": [result.to_dict() for result in results],
    }


def parts_document(cases: Iterable[Mapping[str, EffectivePart]]) -> dict[str, Any]:
    """Return the JSON form of every distinct part of some cases, by id."""
    return {part_id: part.to_dict() for part_id, part in parts_table(cases).items()}


def parts_of(document: Mapping[str, Any]) -> dict[str, EffectivePart]:
    """Return the parts in a document by id; none where an earlier version wrote it.

    Raises KeyError, TypeError or AttributeError where one lacks or adds a field.
    """
    return {part_id: EffectivePart.from_dict(part) for part_id, part in document.get("parts", {}).items()}


def results_of(document: Mapping[str, Any]) -> list[CaseResult]:
    """Return the results in a document.

    Raises:
        ValueError: the document is not of this schema, or a case in it lacks or adds a field.

    """
    found = document.get("schema")
    if found != SCHEMA:
        raise ValueError(f"expected a result document of schema {SCHEMA!r}, found {found!r}")
    try:
        parts = parts_of(document)
        return [CaseResult.from_dict(case, parts) for case in document["cases"]]
    except (KeyError, TypeError, AttributeError) as error:
        raise ValueError(f"the result document is not as schema {SCHEMA!r} has it: {error}") from error


def to_json(document: Mapping[str, Any]) -> str:
    """Return the document as JSON text: two spaces of indentation, newline at the end.

    Raises:
        ValueError: a value in it is NaN or infinite.

    """
    return json.dumps(document, indent=2, ensure_ascii=False, allow_nan=False) + "\n"
