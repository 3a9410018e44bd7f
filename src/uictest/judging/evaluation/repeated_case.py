"""The stops of a repeated case judged together: criterion by criterion, and as a case."""

from __future__ import annotations

import math
import statistics
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import compress
from operator import not_
from typing import Final

from uictest.core.measures import StopMeasures, Wheelsets
from uictest.core.units import value_text
from uictest.judging.evaluation.decision import Bounds, Decision, ObservedStop, bounds_of, decide
from uictest.judging.evaluation.json_values import Outcome
from uictest.judging.evaluation.judgement import (
    Decide,
    Detail,
    undecided,
    verdict_by,
    verdict_of,
    with_definitions,
)
from uictest.judging.evaluation.outcome import RailValidity, decided_by, outcome_of
from uictest.judging.evaluation.repeats import (
    RepeatedStop,
    Repeats,
    Rule,
    column_medians,
    seeds_text,
    stops_needed,
)
from uictest.judging.evaluation.result import CaseResult, over_stops_of_train
from uictest.judging.evaluation.verdict import OverStops, Status, Verdict
from uictest.plans import scenario
from uictest.plans.scenario import Expectation


@dataclass(frozen=True, slots=True)
class OutcomeRule:
    """A rule with the share of stops that must come out alike, from 0 to 1; `median` asks for none."""

    name: Rule
    share: float = 1.0

    def needed(self, stops: int) -> int:
        """Return the number of stops that the rule needs out of `stops`."""
        return stops_needed(self.share, stops)


def decision_over_stops(decisions: Sequence[Decision], bounds: Bounds, rule: OutcomeRule) -> Decision:
    """Return the decision on a criterion over all stops together, given its decision on each.

    Stops that it does not apply to do not count. The value is the median of those that have one. Where the
    remaining stops agree, so does the status. Otherwise `median` judges the median, in which a stop without a
    value may have any; the other rules count the stops that pass: the criterion is inconclusive where those
    that are inconclusive could make up the number needed.
    """
    judged = [decision for decision in decisions if decision.status != "not_applicable"]
    if not judged:
        return decisions[0]
    values = [each.value for each in judged if each.value is not None and math.isfinite(each.value)]
    status = _status_over_stops(judged, values, bounds, rule)
    reason = _reason_over_stops(judged, values, len(decisions), bounds.text, rule)
    if not values:
        return Decision(status, None, reason)
    value = statistics.median(values)
    return Decision(status, value, reason, bounds.side(value))


def over_stops(decisions: Sequence[Decision]) -> OverStops:
    """Return the number of decisions on one criterion by status, and the range of their values."""
    statuses = [decision.status for decision in decisions]
    values = [each.value for each in decisions if each.value is not None and math.isfinite(each.value)]
    return OverStops(
        passed=statuses.count("pass"),
        failed=statuses.count("fail"),
        inconclusive=statuses.count("inconclusive"),
        not_applicable=statuses.count("not_applicable"),
        lowest=min(values, default=None),
        highest=max(values, default=None),
    )


def _status_over_stops(
    judged: Sequence[Decision], values: Sequence[float], bounds: Bounds, rule: OutcomeRule
) -> Status:
    statuses = [decision.status for decision in judged]
    if len(set(statuses)) == 1:
        return statuses[0]
    if rule.name == "median":
        unknown = [math.inf] * (len(judged) - len(values))
        lowest = statistics.median([*(-each for each in unknown), *values])
        holds = bounds.hold_throughout(lowest, statistics.median([*values, *unknown]))
        return "inconclusive" if holds is None else "pass" if holds else "fail"
    passed, needed = statuses.count("pass"), rule.needed(len(judged))
    if passed >= needed:
        return "pass"
    return "inconclusive" if passed + statuses.count("inconclusive") >= needed else "fail"


def _reason_over_stops(
    judged: Sequence[Decision], values: Sequence[float], stops: int, demand: str, rule: OutcomeRule
) -> str:
    text = f"{sum(decision.status == 'pass' for decision in judged)} of {len(judged)} stops pass"
    if rule.name != "median":
        text += f" ({rule.needed(len(judged))} needed)"
    if len(judged) < stops:
        text += f", not applicable to {stops - len(judged)} more"
    if values:
        middle, low, high = (
            value_text(each, "1") for each in (statistics.median(values), min(values), max(values))
        )
        text += f": median {middle} in {low} .. {high}, against {demand}"
    undecided = next((each.reason for each in judged if each.status == "inconclusive"), "")
    return f"{text}; {undecided}" if undecided else text


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
        return "error", _outcome_reason(stops, "error")
    if rule.name == "median":
        return at_median
    is_expected = [stop.as_expected(expect) for stop in stops]
    expected, unexpected = list(compress(stops, is_expected)), list(compress(stops, map(not_, is_expected)))
    needed = rule.needed(len(stops))
    if len(expected) >= needed:
        enough_pass = sum(stop.outcome == "pass" for stop in expected) >= needed
        outcomes = {stop.outcome for stop in expected}
        outcome = next(each for each in _OF_EXPECTED if each in outcomes)
        if enough_pass or outcome == "pass":
            return "pass", ""
        return outcome, _outcome_reason(stops, outcome)
    telling = [candidate for candidate in _MOST_TELLING if candidate in {stop.outcome for stop in unexpected}]
    undecided = sum(stop.outcome == "inconclusive" for stop in unexpected)
    possible = len(expected) + undecided >= needed
    reason = "; ".join(_outcome_reason(stops, candidate) for candidate in telling)
    return "inconclusive" if possible else telling[0], reason


def _outcome_reason(stops: Sequence[RepeatedStop], outcome: Outcome) -> str:
    """Return the number of stops with an outcome, their seeds, and the reason of the first."""
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
    fields = result.outcome, result.reason, result.criteria, result.measures, result.wheelsets, result.rail
    return RepeatedStop(repeat.seed, *fields)


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
        of_criterion = [verdict for verdicts in of_stops for verdict in verdicts if verdict.id == name]
        decisions = [Decision(each.status, each.value, each.reason) for each in of_criterion]
        bounds = bounds_of(criteria[name])
        return verdict_of(criteria[name], bounds, decision_over_stops(decisions, bounds, rule))

    return replace(first, criteria=tuple(over(each.id) for each in first.criteria))


def judge_repeats(
    resolved: scenario.Scenario, repeats: Sequence[SimulatedRepeat], rule: OutcomeRule
) -> Iterator[Verdict]:
    """Yield one verdict per criterion on all stops together, as :func:`judge` does on one.

    Stops that ended in an error are left out; without any other there is no verdict. Definitions run through
    their range in all stops at once.
    """
    stops = [
        ObservedStop(resolved, each.measures, each.wheelset_measures)
        for each in repeats
        if each.measures is not None
    ]
    for profile in resolved.judged_by if stops else ():
        for criterion in profile.criteria:
            verdict = _judge_over_stops(criterion, profile, rule, stops)
            if verdict.layer == "rig" and verdict.status == "fail":
                verdict = replace(verdict, reason=f"{verdict.reason}; {_first_reason(repeats, verdict.id)}")
            yield with_definitions(verdict, criterion, profile, resolved)


def _first_reason(repeats: Sequence[SimulatedRepeat], criterion: str) -> str:
    reasons = (
        f"seed {each.seed}: {verdict.reason}"
        for each in repeats
        for verdict in each.result.criteria
        if verdict.id == criterion and verdict.status == "fail"
    )
    return next(reasons, "")


def _judge_over_stops(
    criterion: scenario.Criterion,
    profile: scenario.Criteria,
    rule: OutcomeRule,
    stops: Sequence[ObservedStop],
) -> Verdict:
    without_value = [undecided(criterion, profile, stop) for stop in stops]
    if criterion.layer == "rig" and rule.name == "median":
        rule = OutcomeRule("all")  # the figures of a stop whose rig is wrong are in every median

    def decider_of(read: scenario.Criterion, bounds: Bounds) -> Decide:
        own = without_value
        if read is not criterion:
            own = [undecided(read, profile, stop) for stop in stops]

        def decide_with(definition: Mapping[str, float], *, explained: bool) -> Decision:
            decisions = [
                known or decide(read, bounds, definition, stop, explained=explained)
                for known, stop in zip(own, stops, strict=True)
            ]
            decision = decision_over_stops(decisions, bounds, rule)
            where = read.speed_range(definition) if explained and decision.value is not None else ""
            return decision._replace(reason=f"{decision.reason} ({where})") if where else decision

        return decide_with

    bounds, stated = bounds_of(criterion), criterion.definition.stated
    detail: Detail = "full" if any(each is None for each in without_value) else "status"
    verdict = verdict_by(criterion, bounds, decider_of, detail=detail)
    pairs = zip(without_value, stops, strict=True)
    of_stops = [known or decide(criterion, bounds, stated, stop, explained=False) for known, stop in pairs]
    return replace(verdict, over_stops=over_stops(of_stops))
