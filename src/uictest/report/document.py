"""What reports add to the result document, as JSON and back: subjects of cases, differences, the baseline."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Annotated, Any, Final

from pydantic import (
    BeforeValidator,
    ConfigDict,
    SerializerFunctionWrapHandler,
    TypeAdapter,
    WrapSerializer,
)

from uictest.judging import evaluation
from uictest.report.content import CaseDescription
from uictest.report.difference import BaselineComparison, Difference

_CONFIG: Final = ConfigDict(extra="forbid", defer_build=True)
_SIDES: Final = ("first", "second")


def _with_nulls(difference: Difference, write: SerializerFunctionWrapHandler) -> dict[str, Any]:
    form: dict[str, Any] = evaluation.json_form(write(difference))
    return form


def _with_nan(content: object) -> object:
    if isinstance(content, Mapping):
        return {**content, **{side: math.nan for side in _SIDES if content.get(side, 0.0) is None}}
    return content


WrittenDifference = Annotated[Difference, WrapSerializer(_with_nulls), BeforeValidator(_with_nan)]
"""In JSON a side without a number is null."""


def _flat(baseline: BaselineComparison, write: SerializerFunctionWrapHandler) -> dict[str, Any]:
    """Return the form with one list of differences, each of which names its case, and with `agrees`."""
    form = write(baseline)
    return {
        "folder": form["folder"],
        "sha256": form["sha256"],
        "agrees": baseline.agrees,
        **form,
        "differences": differences_form(baseline.all_differences),
    }


def _by_case(content: object) -> object:
    if not (isinstance(content, Mapping) and isinstance(content.get("differences"), list)):
        return content
    by_case: dict[str, list[Difference]] = {}
    for difference in evaluation.from_json_form(_DIFFERENCES, content["differences"]):
        by_case.setdefault(difference.case, []).append(difference)
    return {**{name: value for name, value in content.items() if name != "agrees"}, "differences": by_case}


_SUBJECTS: Final = TypeAdapter(
    dict[str, Annotated[CaseDescription, evaluation.required("title", "tags", "settings")]],
    config=ConfigDict(defer_build=True),
)
_DIFFERENCES: Final = TypeAdapter(list[WrittenDifference], config=_CONFIG)
_BASELINE: Final = TypeAdapter(
    list[Annotated[BaselineComparison, WrapSerializer(_flat), BeforeValidator(_by_case)]], config=_CONFIG
)


def subjects_form(subjects: Mapping[str, CaseDescription]) -> dict[str, Any]:
    """Return the JSON form of the subjects of cases, by the ids of the cases."""
    form: dict[str, Any] = evaluation.to_json_form(_SUBJECTS, subjects)
    return form


def read_subjects(document: Mapping[str, Any]) -> dict[str, CaseDescription]:
    """Return the subjects of the cases in a document; none where an earlier version wrote it.

    Raises ValueError where one lacks a field, or a field holds something else.
    """
    try:
        return evaluation.from_json_form(_SUBJECTS, document.get("subjects", {}), place="subjects")
    except ValueError as error:
        raise ValueError(f"not the subject of a case: {error}") from error


def differences_form(differences: Sequence[Difference]) -> list[dict[str, Any]]:
    """Return the JSON form of differences, NaN as None."""
    form: list[dict[str, Any]] = evaluation.to_json_form(_DIFFERENCES, list(differences))
    return form


def baseline_form(baseline: BaselineComparison) -> dict[str, Any]:
    """Return the JSON form of a comparison, with `agrees` for readers that need no more."""
    form: dict[str, Any] = evaluation.to_json_form(_BASELINE, [baseline])[0]
    return form


def read_baseline_comparison(document: Mapping[str, Any]) -> BaselineComparison | None:
    """Return how the run of a document compared with its baseline; None without one.

    Raises ValueError where the document holds something else.
    """
    content = document.get("baseline")
    return evaluation.from_json_form(_BASELINE, [content], place="baseline")[0] if content else None
