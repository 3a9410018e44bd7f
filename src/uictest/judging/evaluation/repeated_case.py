"""From the stops of a repeated case to its result."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from uictest.core.measures import StopMeasures, Wheelsets
from uictest.judging.evaluation.bounds import ObservedStop, bounds_of, why_cut_off
from uictest.judging.evaluation.decision import Decision, decide
from uictest.judging.evaluation.judgement import undecided, verdict_by, with_definitions
from uictest.judging.evaluation.outcome_rule import (
    OutcomeRule,
    decision_over_stops,
    outcome_over_stops,
    over_stops,
    rule_of,
)
from uictest.judging.evaluation.repeats import RepeatedStop, Repeats, column_medians
from uictest.judging.evaluation.result import CaseResult, outcome_of
from uictest.judging.evaluation.verdict import Verdict
from uictest.plans import scenario
from uictest.plans.scenario import TestConditions, test_conditions_of


@dataclass(frozen=True, slots=True)
class SimulatedRepeat:
    """One stop of a repeated case: its seed, its result, and its records; None where it ended in an error.

    The verdicts of the result are without definitions.
    """

    seed: int
    result: CaseResult
    measures: StopMeasures | None = None
    wheelset_measures: Wheelsets = ()


def evaluate_repeats(case: scenario.Case, repeats: Sequence[SimulatedRepeat]) -> CaseResult:
    """Return the result of a case whose stops were simulated, given in the order of their seeds.

    Measures are medians over the stops that have them, verdicts are on all stops together, and the outcome
    follows the rule of the scenario, see :func:`~uictest.judging.evaluation.outcome_rule.outcome_over_stops`.
    """
    rule = rule_of(case.scenario)
    verdicts = tuple(judge_repeats(case.scenario, repeats, rule))
    stops = tuple(_repeated_stop(each) for each in repeats)
    outcome, reason = outcome_over_stops(stops, case.scenario.expect, rule, outcome_of(verdicts))
    simulated = [stop for stop in stops if stop.measures is not None]
    first = repeats[0].result
    return replace(
        first,
        outcome=outcome,
        reason=reason,
        criteria=verdicts,
        measures=column_medians([stop.measures for stop in simulated if stop.measures]) or None,
        wheelsets=tuple(
            column_medians(of_each) for of_each in zip(*(stop.wheelsets for stop in simulated), strict=True)
        ),
        noise_key=next((key for each in repeats if (key := each.result.noise_key)), ""),
        controller_version=next((v for each in repeats if (v := each.result.controller_version)), ""),
        # As of a single stop: whatever the other stops say, none of them is verified.
        requirements=scenario.named_requirements(case.scenario) if outcome == "error" else first.requirements,
        repeats=Repeats(rule.name, stops, rule.share if rule.name == "at_least" else None),
        duration=sum(each.result.duration for each in repeats),
    )


def _repeated_stop(repeat: SimulatedRepeat) -> RepeatedStop:
    result = repeat.result
    own = result.outcome, result.reason, result.criteria, result.measures, result.wheelsets
    return RepeatedStop(repeat.seed, *own)


def judge_repeats(
    resolved: scenario.Scenario, repeats: Sequence[SimulatedRepeat], rule: OutcomeRule
) -> Iterator[Verdict]:
    """Yield one verdict per criterion on all stops together, as :func:`judge` does on one.

    Stops that ended in an error are left out; without any other there is no verdict. Definitions run through
    their range in all stops at once.
    """
    conditions = test_conditions_of(resolved)
    stops = [
        ObservedStop(each.measures, each.wheelset_measures, why_cut_off(resolved, each.measures, None))
        for each in repeats
        if each.measures is not None
    ]
    for profile in resolved.judged_by if stops else ():
        for criterion in profile.criteria:
            verdict = _judge(criterion, conditions, resolved.measures, rule, stops)
            if verdict.layer == "rig" and verdict.status == "fail":
                verdict = replace(verdict, reason=f"{verdict.reason}; {_first_reason(repeats, verdict.id)}")
            yield with_definitions(verdict, criterion, profile, resolved.measures)


def _first_reason(repeats: Sequence[SimulatedRepeat], criterion: str) -> str:
    """Return why the first stop that a check of the rig fails in fails it, with its seed."""
    reasons = (
        f"seed {each.seed}: {verdict.reason}"
        for each in repeats
        for verdict in each.result.criteria
        if verdict.id == criterion and verdict.status == "fail"
    )
    return next(reasons, "")


def _judge(
    criterion: scenario.Criterion,
    conditions: TestConditions,
    observation: scenario.MeasureDefinitions,
    rule: OutcomeRule,
    stops: Sequence[ObservedStop],
) -> Verdict:
    without_value = [undecided(criterion, conditions, stop, observation) for stop in stops]
    if criterion.layer == "rig" and rule.name == "median":
        rule = OutcomeRule("all")  # the figures of a stop whose rig is wrong are in every median

    def decisions(read: scenario.Criterion, definition: Mapping[str, float]) -> list[Decision]:
        own = without_value
        if read is not criterion:
            own = [undecided(read, conditions, stop, observation) for stop in stops]
        pairs = zip(own, stops, strict=True)
        return [known or decide(read, bounds_of(read), definition, stop) for known, stop in pairs]

    def decide_by(read: scenario.Criterion, definition: Mapping[str, float]) -> Decision:
        decision = decision_over_stops(decisions(read, definition), bounds_of(read), read.unit, rule)
        where = read.speed_range(definition) if decision.value is not None else ""
        return replace(decision, reason=f"{decision.reason} ({where})") if where else decision

    explain = any(each is None for each in without_value)
    verdict = verdict_by(criterion, bounds_of(criterion), decide_by, explain=explain)
    stated = criterion.definition.stated()
    return replace(verdict, over_stops=over_stops(decisions(criterion, stated)))
