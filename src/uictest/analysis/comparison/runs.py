"""Two runs compared: outcome, verdicts and measures of each case, then of each series."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Final, TypeVar

from uictest import report
from uictest.analysis.comparison.answer import answer_of, subject_names
from uictest.analysis.comparison.comparison_document import Comparison
from uictest.analysis.comparison.paired_stops import match_groups, paired_comparison, variants_of
from uictest.analysis.comparison.parameters import parameter_changes, short_digest
from uictest.analysis.comparison.tolerance import Tolerances, compare_numbers
from uictest.core.measures import MEASURES, column_unit
from uictest.core.series_measures import SERIES_MEASURES
from uictest.judging import evaluation
from uictest.judging.evaluation import Verdict
from uictest.judging.series import SeriesResult
from uictest.report import Difference, StatusChange, status_difference, wheelset_quantity

MISSING: Final = "missing"
"""Stands for the outcome of a case or series on the side that has none."""
SHARE_PASSED: Final = "share_passed"
"""The share of the stops of a repeated case that pass, among its quantities."""


Quantities = dict[str, list[Difference | None]]
"""Id of a case or series -> an item per quantity compared: None where both sides are the same."""
Result = TypeVar("Result", evaluation.CaseResult, SeriesResult)


def quantities_of_runs(
    first: report.RunContent, second: report.RunContent, tolerances: Tolerances
) -> Quantities:
    """Return the quantities of two runs, whose cases and series are paired by id.

    One on one side only is a difference.
    """
    cases = _paired("case", first.results, second.results, case_differences, tolerances)
    return cases | _paired("series", first.series, second.series, differences_of_series, tolerances)


def _paired(
    kind: str,
    first: Sequence[Result],
    second: Sequence[Result],
    compared: Callable[[Result, Result, Tolerances], Iterator[Difference | None]],
    tolerances: Tolerances,
) -> Quantities:
    ours: dict[str, Result] = {result.id: result for result in first}
    theirs: dict[str, Result] = {result.id: result for result in second}
    quantities: Quantities = {}
    for own_id in dict.fromkeys([*ours, *theirs]):
        if own_id in ours and own_id in theirs:
            quantities[own_id] = list(compared(ours[own_id], theirs[own_id], tolerances))
        else:
            before = ours[own_id].outcome if own_id in ours else MISSING
            after = theirs[own_id].outcome if own_id in theirs else MISSING
            remark = f"the {kind} is on one side only"
            quantities[own_id] = [Difference(own_id, kind, before, after, within=False, remark=remark)]
    return quantities


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


Pair = tuple[evaluation.CaseResult, evaluation.CaseResult]
"""A case on both sides."""


def compare_runs(first: report.RunContent, second: report.RunContent, tolerances: Tolerances) -> Comparison:
    """Compare two runs. Cases and series are paired by id; one on one side only is a difference."""
    ours, theirs = ({result.id: result for result in run.results} for run in (first, second))
    quantities = [each for own in quantities_of_runs(first, second, tolerances).values() for each in own]
    both = [(ours[case_id], theirs[case_id]) for case_id in ours if case_id in theirs]
    parameters = parameter_changes([*both, *stops_of_series(first, second)])
    subjects = subject_names(first, second, parameters)
    matched = match_groups(*_named(first, second, subjects))
    return Comparison(
        first.name,
        second.name,
        len(quantities),
        [difference for difference in quantities if difference is not None],
        list(run_notes(first, second)),
        parameters=parameters,
        paired=paired_comparison(first.name, second.name, matched),
        answer=answer_of(matched, subjects, tolerances),
        series=[result.id for run in (first, second) for result in run.series],
    )


def compare_variants(run: report.RunContent, keys: Sequence[str], tolerances: Tolerances) -> list[Comparison]:
    """Return every variant of a run against the first one, as the keys tell them apart.

    Raises ValueError where there are no two variants, and for a key that none of them has or is given twice.
    """
    first, *others = variants_of(run, keys)
    compared = []
    for other in others:
        subjects = subject_names(first, other, [])
        matched = match_groups(*_named(first, other, subjects), varied=keys)
        paired = paired_comparison(first.name, other.name, matched)
        answer = answer_of(matched, subjects, tolerances)
        compared.append(Comparison(first.name, other.name, paired=paired, answer=answer))
    return compared


def _named(
    first: report.RunContent, second: report.RunContent, names: tuple[str, str]
) -> tuple[report.RunContent, report.RunContent]:
    return dataclasses.replace(first, name=names[0]), dataclasses.replace(second, name=names[1])


def stops_of_series(first: report.RunContent, second: report.RunContent) -> Iterator[Pair]:
    """Yield the cases of series that are on both sides."""
    theirs = {each.case.id: each.case for result in second.series for each in result.cases}
    for case in (each.case for result in first.series for each in result.cases):
        if case.id in theirs:
            yield case, theirs[case.id]


def case_differences(
    first: evaluation.CaseResult, second: evaluation.CaseResult, tolerances: Tolerances
) -> Iterator[Difference | None]:
    """Yield one item per quantity of a case compared: None where both results are the same."""
    case_id = first.id
    yield status_difference(case_id, StatusChange(first.outcome, second.outcome))
    if first.repeats or second.repeats:
        stops = _stops_text(first), _stops_text(second)
        yield None if stops[0] == stops[1] else Difference(case_id, "stops", *stops, within=False)
        yield compare_numbers(case_id, SHARE_PASSED, _share_passed(first), _share_passed(second), tolerances)
    verdicts, others = ({each.id: each.status for each in side.criteria} for side in (first, second))
    for name in dict.fromkeys([*verdicts, *others]):
        yield status_difference(case_id, StatusChange(verdicts.get(name), others.get(name), name))
    ours, theirs = _all_measures(first), _all_measures(second)
    for name in dict.fromkeys([*ours, *theirs]):
        sides = ours.get(name, math.nan), theirs.get(name, math.nan)
        yield compare_numbers(case_id, name, *sides, tolerances, column_unit(name))


def judged_quantities(verdicts: Iterable[Verdict]) -> set[str]:
    """Return the columns of stops and wheelsets, and the measures of series, that criteria judge."""
    measures = [(verdict.measure, MEASURES.get(verdict.measure)) for verdict in verdicts]
    return {measure.column.name if measure and measure.column else name for name, measure in measures}


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
    """Yield what explains differences and does not count as such: a part of a run alone, and other inputs."""
    for run in (first, second):
        if not run.complete:
            yield f"{run.name} is incomplete: not all that was selected was run"
    ours, theirs = first.manifest, second.manifest
    yield from _changed_inputs({"seed": ours.seed}, {"seed": theirs.seed})
    yield from _changed_inputs(ours.versions, theirs.versions, "versions: ")
    yield from _changed_inputs(ours.inputs, theirs.inputs, "inputs: ")


def _changed_inputs(
    first: Mapping[str, str | int | None], second: Mapping[str, str | int | None], prefix: str = ""
) -> Iterator[str]:
    for name in dict.fromkeys([*first, *second]):
        sides = first.get(name), second.get(name)
        if sides[0] != sides[1]:
            texts = (short_digest("none" if side is None else str(side)) for side in sides)
            yield f"{prefix}{name}: {' -> '.join(texts)}"
