"""Two runs compared: outcome, verdicts and measures of each case, then of each series."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from uictest import report
from uictest.analysis.comparison.difference import Comparison
from uictest.analysis.comparison.paired_stops import compare_paired_runs
from uictest.analysis.comparison.parameters import parameter_changes
from uictest.analysis.comparison.tolerance import Scope, Tolerances, compare_numbers
from uictest.core.measures import column_unit
from uictest.core.series_measures import SERIES_MEASURES
from uictest.judging import evaluation
from uictest.judging.series import SeriesResult
from uictest.report import Difference, StatusChange, status_difference, wheelset_quantity


def series_differences(
    first: Sequence[SeriesResult], second: Sequence[SeriesResult], tolerances: Tolerances
) -> Iterator[Difference | None]:
    """Yield one item per quantity of the series compared: None where both sides are the same.

    Series are paired by id; one on one side only is a difference.
    """
    ours, theirs = ({result.id: result for result in side} for side in (first, second))
    for name in dict.fromkeys([*ours, *theirs]):
        if name in ours and name in theirs:
            yield from differences_of_series(ours[name], theirs[name], tolerances)
        else:
            before, after = (side[name].outcome if name in side else "missing" for side in (ours, theirs))
            remark = "the series is on one side only"
            yield Difference(name, "series", before, after, within=False, remark=remark)


def differences_of_series(
    first: SeriesResult, second: SeriesResult, tolerances: Tolerances
) -> Iterator[Difference | None]:
    """Yield one item per quantity of a series compared: None where both sides are the same."""
    yield status_difference(first.id, StatusChange(first.outcome, second.outcome))
    verdicts, others = (
        {each.verdict.id: each.verdict.status for each in side.criteria} for side in (first, second)
    )
    for name in dict.fromkeys([*verdicts, *others]):
        yield status_difference(first.id, StatusChange(verdicts.get(name), others.get(name), name))
    counts, other_counts = _stop_counts(first), _stop_counts(second)
    for quantity in dict.fromkeys([*counts, *other_counts]):
        sides = counts.get(quantity, "none"), other_counts.get(quantity, "none")
        yield None if sides[0] == sides[1] else Difference(first.id, quantity, *sides, within=False)
    numbers, other_numbers = _series_numbers(first), _series_numbers(second)
    for place, name in dict.fromkeys([*numbers, *other_numbers]):
        before, after = (side.get((place, name), math.nan) for side in (numbers, other_numbers))
        quantity = f"{name} from {place}" if place else name
        yield compare_numbers(first.id, quantity, before, after, tolerances, SERIES_MEASURES[name].unit)


def _stop_counts(result: SeriesResult) -> dict[str, str]:
    return {
        f"{role} stops from {speed.place}": f"{each.counted} of {each.run}"
        for speed in result.speeds
        for role, each in (("dry", speed.dry), ("wet", speed.wet))
    }


def _series_numbers(result: SeriesResult) -> dict[tuple[str, str], float]:
    """Return the measures of a series, and those of each rail (with its speed) where it has several."""
    tables = {"": result.measures, **{each.place: each.measures for each in result.speeds if each.rail}}
    return {
        (place, name): math.nan if value.estimate is None else value.estimate.value
        for place, measures in tables.items()
        for name, value in measures.items()
    }


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
        accepted_result = before.pop(result.id, None)
        quantities[result.id] = (
            [_new_series(result)]
            if accepted_result is None
            else list(differences_of_series(accepted_result, result, tolerances))
        )
    missing = [result for result in before.values() if scope.misses(result.id, result.file)]
    quantities |= {result.id: [_missing_series(result)] for result in missing}
    return AcceptedSeries(
        quantities,
        {result.id: result.file for result in (*run, *missing)},
        [own_id for own_id in before if own_id not in quantities],
    )


def _new_series(result: SeriesResult) -> Difference:
    remark = "the baseline has no such series; --accept adds it"
    return Difference(result.id, "series", "missing", result.outcome, within=False, remark=remark)


def _missing_series(result: SeriesResult) -> Difference:
    remark = f"{result.file} no longer has this series; --accept drops it"
    return Difference(result.id, "series", result.outcome, "missing", within=False, remark=remark)


Pair = tuple[evaluation.CaseResult, evaluation.CaseResult]
"""A case on both sides."""

_DIGEST_LENGTH = 64
"""Hexadecimal digits of a SHA-256; readers see the first twelve."""


def compare_runs(first: report.RunContent, second: report.RunContent, tolerances: Tolerances) -> Comparison:
    """Compare two runs. Cases and series are paired by id; one on one side only is a difference."""
    ours, theirs = ({result.id: result for result in run.results} for run in (first, second))
    quantities: list[Difference | None] = []
    for case_id in dict.fromkeys([*ours, *theirs]):
        quantities += _differences_of_case(case_id, ours.get(case_id), theirs.get(case_id), tolerances)
    quantities += series_differences(first.series, second.series, tolerances)
    both = [(ours[case_id], theirs[case_id]) for case_id in ours if case_id in theirs]
    return Comparison(
        first.name,
        second.name,
        len(quantities),
        [difference for difference in quantities if difference is not None],
        list(run_notes(first, second)),
        parameters=parameter_changes([*both, *stops_of_series(first, second)]),
        paired=compare_paired_runs(first, second),
    )


def stops_of_series(first: report.RunContent, second: report.RunContent) -> Iterator[Pair]:
    """Yield the cases of series that are on both sides."""
    theirs = {each.case.id: each.case for result in second.series for each in result.cases}
    for case in (each.case for result in first.series for each in result.cases):
        if case.id in theirs:
            yield case, theirs[case.id]


def _differences_of_case(
    case_id: str,
    first: evaluation.CaseResult | None,
    second: evaluation.CaseResult | None,
    tolerances: Tolerances,
) -> Iterator[Difference | None]:
    """Yield one item per quantity compared: None where both sides are the same."""
    if first is None or second is None:
        before, after = ("missing" if side is None else side.outcome for side in (first, second))
        yield Difference(case_id, "case", before, after, within=False, remark="the case is on one side only")
        return
    yield from case_differences(first, second, tolerances)


def case_differences(
    first: evaluation.CaseResult, second: evaluation.CaseResult, tolerances: Tolerances
) -> Iterator[Difference | None]:
    """Yield one item per quantity of a case compared: None where both results are the same."""
    case_id = first.id
    yield status_difference(case_id, StatusChange(first.outcome, second.outcome))
    if first.repeats or second.repeats:
        stops = _stops_text(first), _stops_text(second)
        yield None if stops[0] == stops[1] else Difference(case_id, "stops", *stops, within=False)
        yield compare_numbers(
            case_id, "share_passed", _share_passed(first), _share_passed(second), tolerances
        )
    verdicts, others = ({each.id: each.status for each in side.criteria} for side in (first, second))
    for name in dict.fromkeys([*verdicts, *others]):
        yield status_difference(case_id, StatusChange(verdicts.get(name), others.get(name), name))
    ours, theirs = _all_measures(first), _all_measures(second)
    for name in dict.fromkeys([*ours, *theirs]):
        sides = ours.get(name, math.nan), theirs.get(name, math.nan)
        yield compare_numbers(case_id, name, *sides, tolerances, column_unit(name))


def _stops_text(result: evaluation.CaseResult) -> str:
    """Return the number of stops of a case, with the rule for its outcome where it is repeated."""
    repeats = result.repeats
    return "1" if repeats is None else f"{len(repeats.stops)}, rule {report.rule_text(repeats)}"


def _share_passed(result: evaluation.CaseResult) -> float:
    repeats = result.repeats
    return float(result.outcome == "pass") if repeats is None else repeats.share


def _all_measures(result: evaluation.CaseResult) -> dict[str, float]:
    measures = dict(result.measures or {})
    for position, wheelset in enumerate(result.wheelsets, start=1):
        measures |= {wheelset_quantity(name, position): value for name, value in wheelset.items()}
    return measures


def run_notes(first: report.RunContent, second: report.RunContent) -> Iterator[str]:
    """Yield the inputs that differ between two runs: they explain differences but do not count as such."""
    ours, theirs = first.manifest, second.manifest
    yield from _changed_inputs({"seed": ours.seed}, {"seed": theirs.seed})
    yield from _changed_inputs(ours.versions, theirs.versions, "versions: ")
    yield from _changed_inputs(ours.inputs, theirs.inputs, "inputs: ")


def _changed_inputs(
    first: Mapping[str, str | int | None], second: Mapping[str, str | int | None], prefix: str = ""
) -> Iterator[str]:
    for name in dict.fromkeys([*first, *second]):
        if first.get(name) != second.get(name):
            yield f"{prefix}{name}: {_input_text(first.get(name))} -> {_input_text(second.get(name))}"


def _input_text(value: str | int | None) -> str:
    text = "none" if value is None else str(value)
    return f"{text[:12]}..." if len(text) == _DIGEST_LENGTH else text
