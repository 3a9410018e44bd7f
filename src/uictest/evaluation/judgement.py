"""Criteria applied to the measures of a stop."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

from uictest.evaluation.applicability import why_not_applicable
from uictest.evaluation.bounds import Bounds
from uictest.evaluation.conditions import TestConditions, test_conditions_of
from uictest.evaluation.coverage import Coverage, ObservedStop, why_cut_off
from uictest.evaluation.decision import Decision, bounds_of, decide
from uictest.evaluation.meaning import applied_definitions, meaning_of
from uictest.evaluation.sensitivity import sensitivity
from uictest.evaluation.verdict import Sensitivity, Verdict
from uictest.measures import StopRecord, WheelsetRecords

if TYPE_CHECKING:
    from uictest.scenario import Criteria, Criterion, MeasureDefinitions, Scenario


def judge(
    scenario: Scenario,
    measures: StopRecord,
    wheelset_measures: WheelsetRecords,
    *,
    explain: bool = True,
    coverage: Coverage | None = None,
) -> list[Verdict]:
    """Judge one stop by every criterion of its scenario, in the order written.

    Args:
        scenario: resolved; says the circumstances and the criteria.
        measures: record of the stop (fields of `measures.StopRecord`, SI).
        wheelset_measures: one record per wheelset from the leading end (`measures.WheelsetRecord`, SI).
        explain: whether the verdicts also say what they were taken to mean and how firmly they stand, which
            takes most of the time.
        coverage: what the record of a real stop lacks; None for a simulation.

    Returns:
        One verdict per criterion: `not_applicable` where the criterion says nothing about such a stop,
        `inconclusive` where data to judge it are missing, both with the reason. NaN never passes.

    """
    circumstances = test_conditions_of(scenario)
    cut_off = why_cut_off(scenario, measures, coverage)
    stop = ObservedStop(measures, wheelset_measures, cut_off, coverage)
    verdicts = []
    for profile in scenario.criteria:
        for criterion in profile.criteria:
            verdict = _judge(criterion, circumstances, stop, scenario.measures, explain=explain)
            verdicts.append(_defined(verdict, criterion, profile, scenario.measures) if explain else verdict)
    return verdicts


def _judge(
    criterion: Criterion,
    circumstances: TestConditions,
    stop: ObservedStop,
    observation: MeasureDefinitions,
    *,
    explain: bool,
) -> Verdict:
    bounds = bounds_of(criterion)
    undecided = _before_judging(criterion, circumstances, stop) or _unobserved(criterion, observation, stop)
    if undecided is not None:
        return _verdict(criterion, bounds, undecided)
    stated = criterion.definition.stated()
    decision = decide(criterion, bounds, stated, stop)
    if not explain or decision.status == "inconclusive":
        return _verdict(criterion, bounds, decision)
    return _verdict(criterion, bounds, decision, *_sensitivities(criterion, bounds, stated, stop))


def _defined(
    verdict: Verdict, criterion: Criterion, profile: Criteria, observation: MeasureDefinitions
) -> Verdict:
    """Return a verdict with what its criterion was taken to mean."""
    return replace(
        verdict,
        definition=meaning_of(criterion, profile, observation),
        definitions=applied_definitions(criterion, profile, observation),
    )


def _before_judging(
    criterion: Criterion, circumstances: TestConditions, stop: ObservedStop
) -> Decision | None:
    """Return the decision on a criterion that does not apply, or of which that is not known; else None."""
    unknown = "" if stop.coverage is None else stop.coverage.no_initial_speed
    initial_speed = None if unknown else float(stop.measures.initial_speed)
    if why_not := why_not_applicable(criterion.applies, circumstances, initial_speed):
        return Decision("not_applicable", None, why_not)
    if criterion.of_simulation and stop.coverage is not None:
        return Decision("not_applicable", None, "a balance of the simulation: a recorded stop has none")
    if unknown and criterion.applies.initial_speed is not None:
        return Decision("inconclusive", None, unknown)
    return None


def _unobserved(criterion: Criterion, observation: MeasureDefinitions, stop: ObservedStop) -> Decision | None:
    """Return that a measure was never observed: it would say that nothing slid or locked; else None."""
    if stop.coverage is not None and stop.coverage.no_initial_speed:
        return None
    moving_speed = observation.moving_speed
    never_faster = stop.measures.initial_speed < moving_speed and math.isnan(
        stop.measures.maximum_deceleration  # kept from the first sample at this speed on
    )
    if never_faster and "moving_speed" in criterion.observed_by:
        why = f"the train never ran at `moving_speed` ({moving_speed.text}), from which on this is observed"
        return Decision("not_applicable", None, why)
    return None


def _sensitivities(
    criterion: Criterion, bounds: Bounds, stated: dict[str, float], stop: ObservedStop
) -> Iterator[Sensitivity]:
    for name, parameter in criterion.definition.parameters().items():

        def at(value: float, name: str = name) -> Decision:
            return decide(criterion, bounds, {**stated, name: value}, stop)

        lower, upper = parameter.range
        yield sensitivity(name, parameter.unit, lower, upper, parameter.step, at)


def _verdict(criterion: Criterion, bounds: Bounds, decision: Decision, *moves: Sensitivity) -> Verdict:
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
        sensitivity=moves,
        measure=criterion.measure,
    )


def _margin(decision: Decision, bounds: Bounds) -> float | None:
    return None if decision.value is None else bounds.margin(decision.value)
