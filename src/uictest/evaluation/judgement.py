"""Criteria applied to the measures of a stop."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

from uictest import scenario
from uictest.evaluation.applicability import TestConditions, test_conditions_of, why_not_applicable
from uictest.evaluation.bounds import Bounds, bounds_of
from uictest.evaluation.coverage import Coverage, ObservedStop, why_cut_off
from uictest.evaluation.decision import Decision, decide
from uictest.evaluation.definitions import applied_definitions, definition_texts
from uictest.evaluation.sensitivity import sensitivity
from uictest.evaluation.verdict import Sensitivity, Verdict
from uictest.measures import StopMeasures, Wheelsets


def judge(
    resolved: scenario.Scenario,
    measures: StopMeasures,
    wheelset_measures: Wheelsets,
    *,
    explain: bool = True,
    coverage: Coverage | None = None,
) -> list[Verdict]:
    """Judge one stop by every criterion of its scenario, in the order written.

    Args:
        resolved: scenario with the conditions of the stop and the criteria.
        measures: record of the stop, SI.
        wheelset_measures: one record per wheelset from the leading end, SI.
        explain: whether the verdicts also list their definitions and whether another value in their range
            would change them, which takes most of the time.
        coverage: what the record of a real stop lacks; None for a simulation.

    Returns:
        One verdict per criterion: `not_applicable` where the criterion does not apply to such a stop,
        `inconclusive` where data to judge it are missing, both with the reason. NaN never passes.

    """
    conditions = test_conditions_of(resolved)
    cut_off = why_cut_off(resolved, measures, coverage)
    stop = ObservedStop(measures, wheelset_measures, cut_off, coverage)
    verdicts = []
    for profile in resolved.criteria:
        for criterion in profile.criteria:
            verdict = _judge(criterion, conditions, stop, resolved.measures, explain=explain)
            if explain:
                verdict = _with_definitions(verdict, criterion, profile, resolved.measures)
            verdicts.append(verdict)
    return verdicts


def _judge(
    criterion: scenario.Criterion,
    conditions: TestConditions,
    stop: ObservedStop,
    observation: scenario.MeasureDefinitions,
    *,
    explain: bool,
) -> Verdict:
    bounds = bounds_of(criterion)
    undecided = _before_judging(criterion, conditions, stop) or _unobserved(criterion, observation, stop)
    if undecided is not None:
        return _verdict(criterion, bounds, undecided)
    stated = criterion.definition.stated()
    decision = decide(criterion, bounds, stated, stop)
    if not explain or decision.status == "inconclusive":
        return _verdict(criterion, bounds, decision)
    return _verdict(criterion, bounds, decision, *_sensitivities(criterion, bounds, stated, stop))


def _with_definitions(
    verdict: Verdict,
    criterion: scenario.Criterion,
    profile: scenario.Criteria,
    observation: scenario.MeasureDefinitions,
) -> Verdict:
    """Return a verdict with the definitions that it depends on."""
    return replace(
        verdict,
        definition=definition_texts(criterion, profile, observation),
        definitions=applied_definitions(criterion, profile, observation),
    )


def _before_judging(
    criterion: scenario.Criterion, conditions: TestConditions, stop: ObservedStop
) -> Decision | None:
    """Return the decision on a criterion that does not apply, or may not apply; None where it applies."""
    unknown = "" if stop.coverage is None else stop.coverage.no_initial_speed
    initial_speed = None if unknown else float(stop.measures.initial_speed)
    if reason := why_not_applicable(criterion.applies, conditions, initial_speed):
        return Decision("not_applicable", None, reason)
    if criterion.of_simulation and stop.coverage is not None:
        return Decision("not_applicable", None, "a balance of the simulation: a recorded stop has none")
    if unknown and criterion.applies.initial_speed is not None:
        return Decision("inconclusive", None, unknown)
    return None


def _unobserved(
    criterion: scenario.Criterion, observation: scenario.MeasureDefinitions, stop: ObservedStop
) -> Decision | None:
    """Return the decision on a measure that was never observed: its zero says nothing; else None."""
    if stop.coverage is not None and stop.coverage.no_initial_speed:
        return None
    moving_speed = observation.moving_speed
    never_faster = stop.measures.initial_speed < moving_speed and math.isnan(
        stop.measures.maximum_deceleration  # kept from the first sample at this speed on
    )
    if never_faster and "moving_speed" in criterion.observed_by:
        reason = f"the train never reached `moving_speed` ({moving_speed.text}), above which this is observed"
        return Decision("not_applicable", None, reason)
    return None


def _sensitivities(
    criterion: scenario.Criterion, bounds: Bounds, stated: dict[str, float], stop: ObservedStop
) -> Iterator[Sensitivity]:
    for name, parameter in criterion.definition.parameters().items():

        def at(value: float, name: str = name) -> Decision:
            return decide(criterion, bounds, {**stated, name: value}, stop)

        lower, upper = parameter.range
        yield sensitivity(name, parameter.unit, lower, upper, parameter.step, at)


def _verdict(
    criterion: scenario.Criterion, bounds: Bounds, decision: Decision, *sensitivities: Sensitivity
) -> Verdict:
    return Verdict(
        id=criterion.id,
        layer=criterion.layer,
        value=decision.value,
        unit=criterion.unit,
        lower=bounds.lower,
        upper=bounds.upper,
        margin=_margin(decision, bounds),
        status=decision.status,
        reason=decision.reason,
        sensitivity=sensitivities,
        measure=criterion.measure,
    )


def _margin(decision: Decision, bounds: Bounds) -> float | None:
    return None if decision.value is None else bounds.margin(decision.value)
