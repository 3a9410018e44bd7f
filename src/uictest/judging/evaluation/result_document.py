"""The document of the results of cases: written, and read back."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Mapping
from typing import Any, Final

from pydantic import ConfigDict, TypeAdapter

from uictest.core import envelope
from uictest.judging.evaluation.json_values import from_json_form, json_form, to_json_form
from uictest.judging.evaluation.parameters import EffectivePart, parts_document, parts_of
from uictest.judging.evaluation.result import CaseResult, WrittenCaseResult

_CASES: Final = TypeAdapter(list[WrittenCaseResult], config=ConfigDict(extra="forbid", defer_build=True))


def result_document(results: Iterable[CaseResult], **header: Any) -> dict[str, Any]:
    """Return the head of results, the header, `parts` and `cases`, with NaN and infinity as None.

    Cases name their parts by ids: a part that many cases share is there once.
    """
    results = list(results)
    return {
        **envelope.head(envelope.RESULT, "run"),
        **json_form(header),
        "parts": parts_document(result.parts for result in results),
        "cases": cases_document(results),
    }


def cases_document(results: Iterable[CaseResult]) -> list[dict[str, Any]]:
    """Return the JSON form of results, NaN and infinity as None, without how long they took."""
    form: list[dict[str, Any]] = to_json_form(_CASES, list(results))
    return form


def cases_of(content: object, parts: Mapping[str, EffectivePart], place: str = "cases") -> list[CaseResult]:
    """Return the results whose JSON form is `content`; `parts` are those they may name, by id.

    `place` is where the content stands in its document. Raises ValueError where a case lacks or adds a field,
    or names another part.
    """
    return from_json_form(_CASES, content, place=place, context=parts)


def results_of(content: Mapping[str, Any]) -> list[CaseResult]:
    """Return the results in a document.

    Raises:
        ValueError: the document is of another schema or kind, or a case in it lacks or adds a field, or two
            share an id.

    """
    try:
        envelope.require(content, envelope.RESULT, "run")
        results = cases_of(content["cases"], parts_of(content))
        _require_distinct(results)
    except KeyError as error:
        raise ValueError(f"no {error}") from error
    return results


def _require_distinct(results: Iterable[CaseResult]) -> None:
    # Readers look cases up by id: of two, one would be compared and the other never seen.
    counts = Counter(result.id for result in results)
    if repeated := [case_id for case_id, count in counts.items() if count > 1]:
        raise ValueError(f"two cases have the id {repeated[0]!r}")


def to_json(content: Mapping[str, Any]) -> str:
    """Return the document as JSON text: two spaces of indentation, newline at the end.

    Raises:
        ValueError: a value in it is NaN or infinite.

    """
    return json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False) + "\n"
