"""What the stops of a repeated case come to: for one criterion, and for the case, whose result it is."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import compress
from operator import not_
from typing import Final

from uictest.core.measures import StopMeasures, Wheelsets
from uictest.judging.evaluation.bounds import ObservedStop, bounds_of, why_cut_off, why_no_stopping
from uictest.judging.evaluation.car_in_train import over_stops_of_train
from uictest.judging.evaluation.criterion_over_stops import OutcomeRule, decision_over_stops, over_stops
from uictest.judging.evaluation.decision import Decision, decide
from uictest.judging.evaluation.json_values import Outcome
from uictest.judging.evaluation.judgement import Detail, undecided, verdict_by, verdict_of, with_definitions
from uictest.judging.evaluation.repeats import (
    RepeatedStop,
    Repeats,
    column_medians,
    seeds_text,
)
from uictest.judging.evaluation.result import CaseResult
from uictest.judging.evaluation.statements import RailValidity, decided_by, outcome_of
from uictest.judging.evaluation.verdict import Verdict
from uictest.plans import scenario
from uictest.plans.scenario import Expectation, TestConditions, test_conditions_of

_MOST_TELLING: Final[tuple[Outcome, ...]] = ("fail", "pass", "invalid", "skipped", "inconclusive")
"""Outcomes of stops that are not as expected, those that say most first."""
_OF_EXPECTED: Final[tuple[Outcome, ...]] = ("fail", "invalid", "pass", "skipped")
"""Outcomes of stops that are: what is allowed comes before `pass`, unless enough stops pass."""


def rule_of(resolved: scenario.Scenario) -> OutcomeRule:
    """Return the rule that a scenario states."""
    stated = resolved.outcome_of_repeats
    if isinstance(stated, scenario.ShareOfStops):
        return OutcomeRule("at_least", float(stated.at_least))
    return OutcomeRule(stated)


def outcome_over_stops(
    stops: Sequence[RepeatedStop], expect: Expectation, rule: OutcomeRule, at_median: tuple[Outcome, str]
) -> tuple[Outcome, str]:
    """Return the outcome of a repeated case and why.

    A stop that ended in an error makes the case one, under every rule. `median` takes the outcome that the
    verdicts at the median have, `at_median`. The other rules count the stops that are as expected; where
    these are too few, the outcome is `inconclusive` if inconclusive stops could make up the number, else the
    most telling outcome of the others: fail, pass, invalid, skipped, inconclusive in this order.
    """
    if any(stop.outcome == "error" for stop in stops):
        return "error", _why(stops, "error")
    if rule.name == "median":
        return at_median
    held = [stop.as_expected(expect) for stop in stops]
    expected, others = list(compress(stops, held)), list(compress(stops, map(not_, held)))
    needed = rule.needed(len(stops))
    if len(expected) >= needed:
        enough_pass = sum(stop.outcome == "pass" for stop in expected) >= needed
        found = {stop.outcome for stop in expected}
        outcome = "pass" if enough_pass else next(each for each in _OF_EXPECTED if each in found)
        return outcome, "" if outcome == "pass" else _why(stops, outcome)
    telling = [each for each in _MOST_TELLING if each in {stop.outcome for stop in others}]
    undecided = sum(stop.outcome == "inconclusive" for stop in others)
    possible = len(expected) + undecided >= needed
    return "inconclusive" if possible else telling[0], "; ".join(_why(stops, each) for each in telling)


def _why(stops: Sequence[RepeatedStop], outcome: Outcome) -> str:
    """Return how many stops have an outcome, their seeds, and the reason of the first."""
    of_outcome = [stop for stop in stops if stop.outcome == outcome]
    seeds = [stop.seed for stop in of_outcome]
    text = f"{outcome} in {len(of_outcome)} of {len(stops)} stops"
    text, reason = f"{text} ({seeds_text(seeds)})", of_outcome[0].reason
    return f"{text}, with seed {seeds[0]}: {reason}" if reason else text


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
    follows the rule of the scenario, see :func:`outcome_over_stops`.
    """
    rule = rule_of(case.scenario)
    verdicts = tuple(judge_repeats(case.scenario, repeats, rule))
    stops = tuple(_repeated_stop(each) for each in repeats)
    rail = _rail_over_stops(case.scenario, repeats, rule)
    at_median = outcome_of(decided_by(verdicts, rail))
    outcome, reason = outcome_over_stops(stops, case.scenario.expect, rule, at_median)
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
        controller_contract=max(each.result.controller_contract for each in repeats),
        # As of a single stop: whatever the other stops say, none of them is verified.
        requirements=scenario.named_requirements(case.scenario) if outcome == "error" else first.requirements,
        repeats=Repeats(rule.name, stops, rule.share if rule.name == "at_least" else None),
        rail=rail,
        train=over_stops_of_train([each.result.train for each in repeats]),
        duration=sum(each.result.duration for each in repeats),
    )


def _repeated_stop(repeat: SimulatedRepeat) -> RepeatedStop:
    result = repeat.result
    own = result.outcome, result.reason, result.criteria, result.measures, result.wheelsets, result.rail
    return RepeatedStop(repeat.seed, *own)


def _rail_over_stops(
    resolved: scenario.Scenario, repeats: Sequence[SimulatedRepeat], rule: OutcomeRule
) -> RailValidity | None:
    """Return the validity of the rail over all stops; of stops that are tests it is their own."""
    first = next((each.result.rail for each in repeats if each.result.rail is not None), None)
    if first is None:
        return None
    of_stops = [
        decided_by(each.result.criteria, each.result.rail and replace(each.result.rail, decides=True))
        for each in repeats
        if each.measures is not None
    ]
    criteria = {each.id: each for profile in resolved.judged_by for each in profile.criteria}

    def over(name: str) -> Verdict:
        own = [verdict for verdicts in of_stops for verdict in verdicts if verdict.id == name]
        decisions = [Decision(each.status, each.value, each.reason) for each in own]
        bounds, unit = bounds_of(criteria[name]), criteria[name].unit
        return verdict_of(criteria[name], bounds, decision_over_stops(decisions, bounds, unit, rule))

    return replace(first, criteria=tuple(over(each.id) for each in first.criteria))


def judge_repeats(
    resolved: scenario.Scenario, repeats: Sequence[SimulatedRepeat], rule: OutcomeRule
) -> Iterator[Verdict]:
    """Yield one verdict per criterion on all stops together, as :func:`judge` does on one.

    Stops that ended in an error are left out; without any other there is no verdict. Definitions run through
    their range in all stops at once.
    """
    conditions = test_conditions_of(resolved)
    stops = [
        ObservedStop(
            each.measures,
            each.wheelset_measures,
            why_cut_off(resolved, each.measures, None),
            no_stopping=why_no_stopping(resolved),
            resolved=resolved,
        )
        for each in repeats
        if each.measures is not None
    ]
    for profile in resolved.judged_by if stops else ():
        for criterion in profile.criteria:
            verdict = _judge(criterion, profile, conditions, resolved.measures, rule, stops)
            if verdict.layer == "rig" and verdict.status == "fail":
                verdict = replace(verdict, reason=f"{verdict.reason}; {_first_reason(repeats, verdict.id)}")
            yield with_definitions(verdict, criterion, profile, resolved)


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
    profile: scenario.Criteria,
    conditions: TestConditions,
    observation: scenario.MeasureDefinitions,
    rule: OutcomeRule,
    stops: Sequence[ObservedStop],
) -> Verdict:
    without_value = [undecided(criterion, profile, conditions, stop, observation) for stop in stops]
    if criterion.layer == "rig" and rule.name == "median":
        rule = OutcomeRule("all")  # the figures of a stop whose rig is wrong are in every median

    def decisions(read: scenario.Criterion, definition: Mapping[str, float]) -> list[Decision]:
        own = without_value
        if read is not criterion:
            own = [undecided(read, profile, conditions, stop, observation) for stop in stops]
        pairs = zip(own, stops, strict=True)
        return [known or decide(read, bounds_of(read), definition, stop) for known, stop in pairs]

    def decide_by(read: scenario.Criterion, definition: Mapping[str, float]) -> Decision:
        decision = decision_over_stops(decisions(read, definition), bounds_of(read), read.unit, rule)
        where = read.speed_range(definition) if decision.value is not None else ""
        return decision._replace(reason=f"{decision.reason} ({where})") if where else decision

    detail: Detail = "full" if any(each is None for each in without_value) else "status"
    verdict = verdict_by(criterion, bounds_of(criterion), decide_by, detail=detail)
    stated = criterion.definition.stated()
    return replace(verdict, over_stops=over_stops(decisions(criterion, stated)))
