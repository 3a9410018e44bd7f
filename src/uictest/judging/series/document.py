"""The series in the results of a run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated, Any, Final

from pydantic import ConfigDict, TypeAdapter

from uictest.core.series_measures import SERIES_MEASURES
from uictest.judging import evaluation
from uictest.judging.series.result import SeriesResult

_FIELDS: Final = frozenset({"parts", "cases", "series"})
_WrittenSeries = Annotated[
    SeriesResult, evaluation.absent_if_empty("requirements", "test_case", "bypassed_k_wet", "firmness")
]
_SERIES: Final = TypeAdapter(list[_WrittenSeries], config=ConfigDict(extra="forbid", defer_build=True))


def series_document(results: Sequence[SeriesResult]) -> dict[str, Any]:
    """Return `{"parts": {...}, "cases": [...], "series": [...]}`.

    A series names its cases by their ids; the cases of all series stand once, as in a result document.
    """
    cases = [each.case for result in results for each in result.cases]
    return {
        "parts": evaluation.parts_document(case.parts for case in cases),
        "cases": evaluation.cases_document(cases),
        "series": evaluation.to_json_form(_SERIES, list(results)),
    }


def series_results_of(document: object) -> list[SeriesResult]:
    """Return the series in the form that :func:`series_document` gives.

    Raises ValueError where it lacks or adds a field, holds a value of another type, or names a case that it
    does not hold.
    """
    if not isinstance(document, Mapping):
        raise ValueError(f"series: expected an object, found {document!r}")
    if document.keys() != _FIELDS:
        raise ValueError(f"series: expected the fields {', '.join(sorted(_FIELDS))}")
    cases = evaluation.cases_of(document["cases"], evaluation.parts_of(document), "series.cases")
    by_id = {case.id: case for case in cases}
    if len(by_id) < len(cases):
        raise ValueError("series.cases: two cases have the same id")
    results = evaluation.from_json_form(_SERIES, document["series"], place="series", context=by_id)
    for place, result in enumerate(results):
        _require_possible(result, f"series.{place}")
    return results


def _require_possible(result: SeriesResult, place: str) -> None:
    """Raise ValueError for a measure that no series has, or for more stops than there are."""
    for measures in (result.measures, *(speed.measures for speed in result.speeds)):
        if unknown := sorted(measures.keys() - SERIES_MEASURES.keys()):
            raise ValueError(f"{place}: no series has a measure {unknown[0]!r}")
    for each in result.criteria:
        if each.kept is not None and not 0 <= each.kept <= (each.stops or 0):
            raise ValueError(f"{place}.criteria: {each.kept} of {each.stops} stops keep {each.verdict.id!r}")
    for speed in result.speeds:
        for counts in (speed.dry, speed.wet):
            if not 0 <= counts.counted <= counts.run:
                raise ValueError(f"{place}.speeds: {counts.counted} of {counts.run} stops count")
