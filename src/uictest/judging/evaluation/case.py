"""From a case and the measures of its stop to its result."""

from __future__ import annotations

import math
from collections.abc import Container, Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Final

from uictest.controllers import ResponseTimes
from uictest.core.measures import (
    MEASURES,
    STOP_COLUMNS,
    StopMeasures,
    Wheelsets,
    stop_column_values,
    wheelset_column_values,
)
from uictest.judging.evaluation.decision import Coverage
from uictest.judging.evaluation.judgement import Detail, judge, missed_deadlines
from uictest.judging.evaluation.outcome import RailValidity, decided_by, outcome_of
from uictest.judging.evaluation.result import CaseResult, CouplerForces, place_in_train
from uictest.judging.evaluation.verdict import Verdict
from uictest.plans import scenario

_FINITE_IN_STOPS: Final = (
    *("end_time", "end_distance", "end_speed"),
    *(each.finite_field for each in MEASURES.values() if each.finite_field and not each.of_wheelsets),
)
_FINITE_IN_WHEELSETS: Final = tuple(
    each.finite_field for each in MEASURES.values() if each.finite_field and each.of_wheelsets
)
"""Fields of the records that hold a number after every simulated stop; the others may be NaN."""

_RELATIVE_TO_THE_AIR_TAKEN: Final = frozenset({"air_residual", "air_energy_residual"})

_DEFAULTS: Final = {
    name: value for column in STOP_COLUMNS.values() for name, value in column.defaults.items()
}


def evaluate(
    case: scenario.Case,
    measures: StopMeasures,
    wheelset_measures: Wheelsets,
    duration: float = 0.0,
    *,
    detail: Detail = "full",
    coverage: Coverage | None = None,
    response_times: ResponseTimes | None = None,
    of_record: Iterable[Verdict] = (),
) -> CaseResult:
    """Return the judged result of a case whose stop was simulated or recorded.

    Args:
        case: what was to be done.
        measures: record of the stop, SI.
        wheelset_measures: one record per wheelset from the leading end, SI.
        duration: wall clock the simulation took, s.
        detail: as for :func:`judge`.
        coverage: as for :func:`judge`.
        response_times: response times of the controller in a stop that was paced by the clock.
        of_record: whether the record of a real stop agrees with the case.

    """
    verdicts = judge(case.scenario, measures, wheelset_measures, detail=detail, coverage=coverage)
    verdicts = [*verdicts, *missed_deadlines(response_times), *of_record]
    outcome, reason = outcome_of(verdicts)
    corrections = {name: float(value) for name, value in scenario.corrections(case.scenario).items()}
    of_stop = stop_column_values(measures, {**_column_definition(case.scenario.criteria), **corrections})
    of_wheelsets = [wheelset_column_values(wheelset) for wheelset in wheelset_measures]
    if case.scenario.drag is not None:
        of_stop = _without_columns(_COLUMNS_OF_BRAKING, of_stop)
    if coverage is not None:
        of_stop = _without_columns(_unknown_columns(coverage, of_wheelsets=False), of_stop)
        unknown = _unknown_columns(coverage, of_wheelsets=True)
        of_wheelsets = [_without_columns(unknown, columns) for columns in of_wheelsets]
    return CaseResult(
        id=case.id,
        scenario=case.path.as_posix(),
        parameters=dict(case.parameters),
        expect=case.scenario.expect,
        outcome=outcome,
        reason=reason,
        criteria=tuple(verdicts),
        measures=of_stop,
        wheelsets=tuple(of_wheelsets),
        response_times=response_times,
        requirements=case.scenario.requirements,
        test_case=case.scenario.test_case or "",
        train=place_in_train(case),
        duration=duration,
    )


def evaluate_simulated(
    case: scenario.Case,
    measures: StopMeasures,
    wheelset_measures: Wheelsets,
    duration: float = 0.0,
    *,
    detail: Detail = "full",
    response_times: ResponseTimes | None = None,
    couplers: tuple[tuple[float, float] | None, tuple[float, float] | None] = (None, None),
) -> CaseResult:
    """Return the judged result of a simulated case, outcome `error` where a measure is not finite.

    Arguments as for :func:`evaluate`, and

    Args:
        couplers: largest pull and push of the coupler ahead of a car in a train, and of that behind it, N.
    """
    if not_finite := list(_not_finite(measures, wheelset_measures)):
        result = error_result(case, _why_not_finite(measures, not_finite), duration)
    else:
        result = evaluate(
            case, measures, wheelset_measures, duration, detail=detail, response_times=response_times
        )
    if result.train is None:
        return result
    ahead, behind = (None if each is None else CouplerForces(*each) for each in couplers)
    return replace(result, train=replace(result.train, ahead=ahead, behind=behind))


def error_result(case: scenario.Case, reason: str, duration: float = 0.0) -> CaseResult:
    """Return the result of a case whose simulation failed: outcome `error`, why, and nothing judged.

    It names the requirements of its criteria as its own: none of them is verified.
    """
    return CaseResult(
        id=case.id,
        scenario=case.path.as_posix(),
        parameters=dict(case.parameters),
        expect=case.scenario.expect,
        outcome="error",
        reason=reason,
        requirements=scenario.named_requirements(case.scenario),
        test_case=case.scenario.test_case or "",
        train=place_in_train(case),
        duration=duration,
    )


def may_be_biased(result: CaseResult, biases: Mapping[str, float]) -> bool:
    """Return whether the biases of measures, as shares of their values, may have decided a result.

    So they may where a value lies within its bias of a bound, and where a stop did not end, lacks data or
    could not be judged. A measure that is not among `biases` may be biased by any amount.
    """
    if result.measures is None or math.isnan(result.measures["braking_time_s"]):
        return True
    return any(
        _may_be_biased(each, biases.get(each.measure, math.inf))
        for each in (*result.criteria, *result.decided)
    )


def _may_be_biased(verdict: Verdict, bias: float) -> bool:
    if verdict.status in ("not_applicable", "inconclusive"):
        return verdict.status == "inconclusive"
    if math.isinf(bias) or verdict.value is None or verdict.margin is None:
        return math.isinf(bias)
    at_bound = verdict.margin == 0.0 and bias > 0.0
    return at_bound or abs(verdict.margin) < bias * abs(verdict.value)


def _column_definition(profiles: tuple[scenario.Criteria, ...]) -> dict[str, float]:
    """Return the definitions that columns use: those of the first criterion that has them, else the defaults.

    A column then agrees with the verdict of that criterion.
    """
    return {name: _stated_parameter(profiles, name, default) for name, default in _DEFAULTS.items()}


def _stated_parameter(profiles: tuple[scenario.Criteria, ...], name: str, default: float) -> float:
    for profile in profiles:
        for criterion in profile.criteria:
            parameter = getattr(criterion.definition, name)
            if parameter is not None:
                return float(parameter.value)
    return default


def _unknown_columns(coverage: Coverage, *, of_wheelsets: bool) -> set[str]:
    """Return the columns of stops or of wheelsets whose measure lacks data in a record, for any wheelset."""
    lacking = (measure for name, measure in MEASURES.items() if name in coverage.missing)
    return {each.column.name for each in lacking if each.column and each.of_wheelsets == of_wheelsets}


_COLUMNS_OF_BRAKING: Final = frozenset(
    each.column.name
    for each in MEASURES.values()
    if each.column and (each.of_braking or each.of_standstill) and not each.of_wheelsets
)
"""Columns that say nothing of a stop in which traction held a speed."""


def _without_columns(unknown: Container[str], columns: Mapping[str, float]) -> dict[str, float]:
    return {name: math.nan if name in unknown else value for name, value in columns.items()}


def _not_finite(measures: StopMeasures, wheelsets: Wheelsets) -> Iterator[str]:
    yield from (name for name in _FINITE_IN_STOPS if not math.isfinite(getattr(measures, name)))
    for number, wheelset in enumerate(wheelsets, start=1):
        for name in _FINITE_IN_WHEELSETS:
            if not math.isfinite(getattr(wheelset, name)):
                yield f"{name}_{number}"


def _why_not_finite(measures: StopMeasures, names: list[str]) -> str:
    if measures.air_consumed == 0.0 and _RELATIVE_TO_THE_AIR_TAKEN.issuperset(names):
        return (
            f"the stop ended after {measures.end_time:.3g} s, before the brake took any air, so that the"
            " balances of the air have no value; brake from a higher speed or with a shorter dead time"
        )
    listed = ", ".join(names[:3]) + (", ..." if len(names) > 3 else "")
    return f"the simulation gives no finite {listed}: the numbers of the scenario do not fit together"


def asks_for_rail(case: scenario.Case, result: CaseResult) -> bool:
    """Return whether the rail is to be looked at: it decides, or the stop with its WSP is not a test.

    On a dry rail the WSP has no part in that.
    """
    of_validity = [each for each in result.criteria if each.layer == "validity" and each.value is not None]
    missed = any(each.status == "fail" for each in of_validity)
    resolved = case.scenario
    if not (missed or (of_validity and resolved.test_validity != "measured")):
        return False
    return resolved.rig.wsp == "active" and resolved.drag is None and resolved.rail.condition.name != "dry"


def with_rail(
    result: CaseResult, case: scenario.Case, measures: StopMeasures, wheelset_measures: Wheelsets
) -> CaseResult:
    """Return a result with the validity of the rail, which decides where the scenario says so.

    Args:
        result: result of the stop with the WSP active.
        case: with the WSP active: its criteria of validity judge both stops.
        measures: record of the same stop, with the WSP bypassed, SI.
        wheelset_measures: one record per wheelset of that stop.
    """
    verdicts = judge(case.scenario, measures, wheelset_measures, detail="status")
    of_validity = tuple(each for each in verdicts if each.layer == "validity")
    decides = case.scenario.test_validity == "rail"
    locks = any(wheelset.longest_lock >= 1.0 for wheelset in wheelset_measures)
    rail = RailValidity(of_validity, case.scenario.rail.friction_as_found, locks, decides)
    outcome, reason = outcome_of(decided_by(result.criteria, rail))
    return replace(result, rail=rail, outcome=outcome, reason=reason)
