"""Compare the series of a run with those that were accepted before."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from uictest.analysis.comparison.scope import Scope
from uictest.analysis.comparison.series import differences_of_series
from uictest.analysis.comparison.tolerance import Tolerances
from uictest.judging.series import SeriesResult
from uictest.report import Difference


@dataclass(frozen=True, slots=True)
class AcceptedSeries:
    """Series against a baseline.

    `quantities` has an item per quantity compared of each series, by its id: None where both sides are the
    same. `files` has the file of each of these series. `not_compared` are ids of accepted series that were
    not run or not selected.
    """

    quantities: Mapping[str, Sequence[Difference | None]]
    files: Mapping[str, str]
    not_compared: Sequence[str]


def compare_accepted_series(
    accepted: Sequence[SeriesResult], run: Sequence[SeriesResult], scope: Scope, tolerances: Tolerances
) -> AcceptedSeries:
    """Compare the series of a run; one that its file no longer has, or that is new, is a difference."""
    before = {result.id: result for result in accepted}
    quantities: dict[str, Sequence[Difference | None]] = {}
    for result in run:
        known = before.pop(result.id, None)
        quantities[result.id] = (
            [_new(result)] if known is None else list(differences_of_series(known, result, tolerances))
        )
    missing = [result for result in before.values() if scope.misses(result.id, result.file)]
    quantities |= {result.id: [_missing(result)] for result in missing}
    return AcceptedSeries(
        quantities,
        {result.id: result.file for result in (*run, *missing)},
        [own_id for own_id in before if own_id not in quantities],
    )


def _new(result: SeriesResult) -> Difference:
    remark = "the baseline has no such series; --accept adds it"
    return Difference(result.id, "series", "missing", result.outcome, within=False, remark=remark)


def _missing(result: SeriesResult) -> Difference:
    remark = f"{result.file} no longer has this series; --accept drops it"
    return Difference(result.id, "series", result.outcome, "missing", within=False, remark=remark)
