"""Criteria applied to the measures of a stop."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from uictest.evaluation.applicability import why_not_applicable
from uictest.evaluation.bounds import Bounds
from uictest.evaluation.circumstances import Circumstances, circumstances_of
from uictest.evaluation.decision import Decision, bounds_of, decide
from uictest.evaluation.meaning import meaning_of
from uictest.evaluation.records import StopMeasures, Wheelsets
from uictest.evaluation.sensitivity import sensitivity
from uictest.evaluation.verdict import Sensitivity, Verdict

if TYPE_CHECKING:
    from uictest.scenario import Scenario
    from uictest.scenario.parts.criteria import Criterion


def judge(
    scenario: Scenario,
    measures: StopMeasures,
    wheelset_measures: Wheelsets,
    *,
    explain: bool = True,
    missing: Mapping[str, str] | None = None,
) -> list[Verdict]:
    """Judge one stop by every criterion of its scenario, in the order written.

    Args:
        scenario: resolved; says the circumstances and the criteria.
        measures: record of the stop (fields of `records.StopMeasures`, SI).
        wheelset_measures: one record per wheelset from the leading end (`records.WheelsetMeasures`, SI).
        explain: whether the verdicts also say what they were taken to mean and how firmly they stand, which
            takes most of the time.
        missing: measures that a measured record does not support, each with the reason.

    Returns:
        One verdict per criterion. A criterion that does not apply, or that the record cannot support, is
        `not_applicable` with its reason. NaN never passes.

    """
    stop = circumstances_of(scenario)
    criteria = (
        (criterion, meaning_of(criterion, profile, scenario.measures) if explain else {})
        for profile in scenario.criteria
        for criterion in profile.criteria
    )
    reasons = missing or {}
    return [
        _judge(
            criterion,
            meant,
            stop,
            measures,
            wheelset_measures,
            explain=explain,
            missing=reasons.get(criterion.measure, ""),
        )
        for criterion, meant in criteria
    ]


def _judge(
    criterion: Criterion,
    meant: dict[str, str],
    stop: Circumstances,
    measures: StopMeasures,
    wheelsets: Wheelsets,
    *,
    explain: bool,
    missing: str,
) -> Verdict:
    why_not = why_not_applicable(criterion.applies, stop, float(measures.initial_speed)) or missing
    if why_not:
        return _verdict(criterion, Decision("not_applicable", None, why_not), meant)
    stated = criterion.definition.stated()
    decision = decide(criterion, stated, measures, wheelsets)
    moves = _sensitivities(criterion, stated, measures, wheelsets) if explain else ()
    return _verdict(criterion, decision, meant, *moves)


def _sensitivities(
    criterion: Criterion, stated: dict[str, float], measures: StopMeasures, wheelsets: Wheelsets
) -> Iterator[Sensitivity]:
    for name, parameter in criterion.definition.parameters().items():

        def at(value: float, name: str = name) -> Decision:
            return decide(criterion, {**stated, name: value}, measures, wheelsets)

        lower, upper = parameter.range
        yield sensitivity(name, parameter.unit, lower, upper, parameter.step, at)


def _verdict(criterion: Criterion, decision: Decision, meant: dict[str, str], *moves: Sensitivity) -> Verdict:
    bounds = bounds_of(criterion)
    return Verdict(
        id=criterion.id,
        layer=criterion.layer,
        value=decision.value,
        unit=criterion.unit,
        lower=bounds.lower,
        upper=bounds.upper,
        margin=_margin(decision, bounds),
        verdict=decision.verdict,
        reason=decision.reason,
        definition=meant,
        sensitivity=moves,
    )


def _margin(decision: Decision, bounds: Bounds) -> float | None:
    return None if decision.value is None else bounds.margin(decision.value)
