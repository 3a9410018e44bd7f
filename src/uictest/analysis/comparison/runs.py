"""Two runs: case by case outcome, verdicts and measures, then series, then stops under the same noise."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from uictest import report
from uictest.analysis.comparison.difference import Comparison
from uictest.analysis.comparison.paired.pairing import compare_paired_runs
from uictest.analysis.comparison.parameters import parameter_changes
from uictest.analysis.comparison.series import series_differences
from uictest.analysis.comparison.tolerance import Tolerances, compare_numbers
from uictest.core.measures import column_unit
from uictest.judging import evaluation
from uictest.report import Difference, wheelset_quantity

Pair = tuple[evaluation.CaseResult, evaluation.CaseResult]
"""A case on both sides."""

_DIGEST_LENGTH = 64
"""Hexadecimal digits of a SHA-256; readers see the first twelve."""


def compare_runs(first: report.RunContent, second: report.RunContent, tolerances: Tolerances) -> Comparison:
    """Compare two runs. Cases and series are paired by id; one on one side only is a difference."""
    ours, theirs = ({result.id: result for result in run.results} for run in (first, second))
    quantities: list[Difference | None] = []
    for case_id in dict.fromkeys([*ours, *theirs]):
        quantities += _case(case_id, ours.get(case_id), theirs.get(case_id), tolerances)
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


def _case(
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
    yield _texts(case_id, "outcome", first.outcome, second.outcome)
    if first.repeats or second.repeats:
        yield _texts(case_id, "stops", *map(_stops, (first, second)))
        yield compare_numbers(case_id, "share_passed", _share(first), _share(second), tolerances)
    verdicts, others = _verdicts(first), _verdicts(second)
    for name in dict.fromkeys([*verdicts, *others]):
        yield _texts(case_id, f"criterion {name}", verdicts.get(name, "none"), others.get(name, "none"))
    ours, theirs = _measures(first), _measures(second)
    for name in dict.fromkeys([*ours, *theirs]):
        sides = ours.get(name, math.nan), theirs.get(name, math.nan)
        yield compare_numbers(case_id, name, *sides, tolerances, column_unit(name))


def _texts(case_id: str, quantity: str, first: str, second: str) -> Difference | None:
    return None if first == second else Difference(case_id, quantity, first, second, within=False)


def _stops(result: evaluation.CaseResult) -> str:
    """Return how many stops a case has and under which rule they come out."""
    repeats = result.repeats
    return "1" if repeats is None else f"{len(repeats.stops)}, rule {report.rule_text(repeats)}"


def _share(result: evaluation.CaseResult) -> float:
    repeats = result.repeats
    return float(result.outcome == "pass") if repeats is None else repeats.share


def _verdicts(result: evaluation.CaseResult) -> dict[str, str]:
    return {verdict.id: verdict.status.replace("_", " ") for verdict in result.criteria}


def _measures(result: evaluation.CaseResult) -> dict[str, float]:
    measures = dict(result.measures or {})
    for position, wheelset in enumerate(result.wheelsets, start=1):
        measures |= {wheelset_quantity(name, position): value for name, value in wheelset.items()}
    return measures


def run_notes(first: report.RunContent, second: report.RunContent) -> Iterator[str]:
    """Yield the inputs that differ between two runs: they explain differences but do not count as such."""
    ours, theirs = first.manifest, second.manifest
    yield from _changes({"seed": ours.seed}, {"seed": theirs.seed})
    yield from _changes(ours.versions, theirs.versions, "versions: ")
    yield from _changes(ours.inputs, theirs.inputs, "inputs: ")


def _changes(
    first: Mapping[str, str | int | None], second: Mapping[str, str | int | None], prefix: str = ""
) -> Iterator[str]:
    """Yield a line for each name whose values differ."""
    for name in dict.fromkeys([*first, *second]):
        if first.get(name) != second.get(name):
            yield f"{prefix}{name}: {_shown(first.get(name))} -> {_shown(second.get(name))}"


def _shown(value: str | int | None) -> str:
    text = "none" if value is None else str(value)
    return f"{text[:12]}..." if len(text) == _DIGEST_LENGTH else text
