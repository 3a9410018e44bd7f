"""The results of cases in a document."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Mapping
from typing import Annotated, Any, Final

from pydantic import ConfigDict, SerializerFunctionWrapHandler, TypeAdapter, WrapSerializer

from uictest.core import document
from uictest.judging.evaluation.json_values import from_json_form, json_form, required, to_json_form
from uictest.judging.evaluation.parameters import EffectivePart, parts_document, parts_of
from uictest.judging.evaluation.result import CaseResult

_OF_SOME: Final = (
    *("response_times", "controller_version", "case_sha256"),
    *("requirements", "test_case", "noise_key", "repeats", "domain_of_validity", "strict"),
)
"""Fields that the form of a result or a verdict has only where there is something in them."""


def _without_empty(result: CaseResult, write: SerializerFunctionWrapHandler) -> dict[str, Any]:
    form = _filled(write(result))
    return {**form, "criteria": [_filled(verdict) for verdict in form["criteria"]]}


def _filled(form: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in form.items() if value or name not in _OF_SOME}


# In code these three default to those of a case that was not simulated.
WrittenCaseResult = Annotated[
    CaseResult, required("criteria", "measures", "wheelsets"), WrapSerializer(_without_empty)
]
"""A result as documents hold it."""

_CASES: Final = TypeAdapter(list[WrittenCaseResult], config=ConfigDict(extra="forbid", defer_build=True))


def result_document(results: Iterable[CaseResult], **header: Any) -> dict[str, Any]:
    """Return the head of results, the header, `parts` and `cases`, with NaN and infinity as None.

    Cases name their parts by ids: a part that many cases share is there once.
    """
    results = list(results)
    return {
        **document.head(document.RESULT, "run"),
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
        document.require(content, document.RESULT, "run")
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
