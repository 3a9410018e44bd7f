"""What the stops of a repeated case come to: for one criterion, and for the case, whose result it is."""

from __future__ import annotations

import math
import statistics
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

from uictest.core.measures import StopMeasures, Wheelsets
from uictest.core.units import value_text, with_unit
from uictest.judging.evaluation.bounds import Bounds, ObservedStop, bounds_of, why_cut_off, why_no_stopping
from uictest.judging.evaluation.car_in_train import over_stops_of_train
from uictest.judging.evaluation.decision import Decision, decide
from uictest.judging.evaluation.json_values import Expectation, Outcome
from uictest.judging.evaluation.judgement import Detail, undecided, verdict_by, with_definitions
from uictest.judging.evaluation.repeats import RepeatedStop, Repeats, Rule, column_medians, is_expected
from uictest.judging.evaluation.result import CaseResult, outcome_of
from uictest.judging.evaluation.verdict import OverStops, Status, Verdict
from uictest.plans import scenario
from uictest.plans.scenario import TestConditions, test_conditions_of

_MOST_TELLING: Final[tuple[Outcome, ...]] = ("fail", "pass", "invalid", "skipped", "inconclusive")
"""Outcomes that may not be the expected one, those that say most of a stop first."""

_SEEDS_LISTED: Final = 6
"""Seeds, or runs of them, that a reason names at most; chosen."""


@dataclass(frozen=True, slots=True)
class OutcomeRule:
    """A rule with the share of stops that must come out alike, from 0 to 1; `median` asks for none."""

    name: Rule
    share: float = 1.0

    def needed(self, stops: int) -> int:
        """Return how many of so many stops that is."""
        # Not 10 of 10 stops where 0.9 times 10 is a little above 9 in binary.
        return math.ceil(self.share * stops - 1e-9)


def rule_of(resolved: scenario.Scenario) -> OutcomeRule:
    """Return the rule that a scenario states."""
    stated = resolved.outcome_of_repeats
    if isinstance(stated, scenario.ShareOfStops):
        return OutcomeRule("at_least", float(stated.at_least))
    return OutcomeRule(stated)


def decision_over_stops(
    decisions: Sequence[Decision], bounds: Bounds, unit: str, rule: OutcomeRule
) -> Decision:
    """Return what a criterion says of all stops together, given its decision on each.

    Stops that it does not apply to do not count. The value is the median of those that have one. Where the
    remaining stops agree, so does the status. Otherwise `median` judges the median, in which a stop without a
    value may have any; the other rules count the stops that pass: the criterion is inconclusive where those
    that are inconclusive could make up the number needed.
    """
    judged = [decision for decision in decisions if decision.status != "not_applicable"]
    if not judged:
        return decisions[0]
    values = [each.value for each in judged if each.value is not None and math.isfinite(each.value)]
    status = _status(judged, values, bounds, rule)
    reason = _reason(judged, values, len(decisions), with_unit(str(bounds), unit), rule)
    if not values:
        return Decision(status, None, reason)
    value = statistics.median(values)
    return Decision(status, value, reason, bounds.side(value))


def over_stops(decisions: Sequence[Decision]) -> OverStops:
    """Return how many of the decisions on one criterion have each status, and the range of their values."""
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


def _status(judged: Sequence[Decision], values: Sequence[float], bounds: Bounds, rule: OutcomeRule) -> Status:
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


def _reason(
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


def outcome_over_stops(
    stops: Sequence[RepeatedStop], expect: Expectation, rule: OutcomeRule, at_median: tuple[Outcome, str]
) -> tuple[Outcome, str]:
    """Return the outcome of a repeated case and why.

    A stop that ended in an error makes the case one, under every rule. `median` takes the outcome that the
    verdicts at the median have, `at_median`. The other rules count the stops with the expected outcome; where
    these are too few, the outcome is `inconclusive` if inconclusive stops could make up the number, else the
    most telling outcome that was not expected: fail, pass, invalid, skipped, inconclusive in this order.
    """
    outcomes = [stop.outcome for stop in stops]
    if "error" in outcomes:
        return "error", _why(stops, "error")
    if rule.name == "median":
        return at_median
    expected, needed = sum(is_expected(each, expect) for each in outcomes), rule.needed(len(stops))
    if expected >= needed:
        return _as_expected(stops, expect)
    others = [each for each in _MOST_TELLING if each in outcomes and not is_expected(each, expect)]
    possible = expected + outcomes.count("inconclusive") >= needed
    return "inconclusive" if possible else others[0], "; ".join(_why(stops, each) for each in others)


def _as_expected(stops: Sequence[RepeatedStop], expect: Expectation) -> tuple[Outcome, str]:
    return expect, "" if expect == "pass" else _why(stops, expect)


def _why(stops: Sequence[RepeatedStop], outcome: Outcome) -> str:
    """Return how many stops have an outcome, their seeds, and the reason of the first."""
    of_outcome = [stop for stop in stops if stop.outcome == outcome]
    seeds = [stop.seed for stop in of_outcome]
    text = f"{outcome} in {len(of_outcome)} of {len(stops)} stops"
    text, reason = f"{text} ({seeds_text(seeds)})", of_outcome[0].reason
    return f"{text}, with seed {seeds[0]}: {reason}" if reason else text


def seeds_text(seeds: Sequence[int]) -> str:
    """Return rising seeds for a reader, e.g. `seed 3`, `seeds 0, 2, 4..9`; of many the first ones."""
    runs = list(_runs(seeds))
    shown = ", ".join(_run_text(*run) for run in runs[:_SEEDS_LISTED])
    more = sum(last - first + 1 for first, last in runs[_SEEDS_LISTED:])
    named = f"seed {shown}" if len(seeds) == 1 else f"seeds {shown}"
    return f"{named} and {more} more" if more else named


def _runs(seeds: Sequence[int]) -> Iterator[tuple[int, int]]:
    """Yield the first and the last of each run of seeds that follow each other."""
    first: int | None = None
    for place, seed in enumerate(seeds):
        first = seed if first is None else first
        if place + 1 == len(seeds) or seeds[place + 1] != seed + 1:
            yield first, seed
            first = None


def _run_text(first: int, last: int) -> str:
    if last - first > 1:
        return f"{first}..{last}"
    return str(first) if first == last else f"{first}, {last}"


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
        controller_contract=max(each.result.controller_contract for each in repeats),
        # As of a single stop: whatever the other stops say, none of them is verified.
        requirements=scenario.named_requirements(case.scenario) if outcome == "error" else first.requirements,
        repeats=Repeats(rule.name, stops, rule.share if rule.name == "at_least" else None),
        train=over_stops_of_train([each.result.train for each in repeats]),
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
        ObservedStop(
            each.measures,
            each.wheelset_measures,
            why_cut_off(resolved, each.measures, None),
            no_stopping=why_no_stopping(resolved),
        )
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
        return decision._replace(reason=f"{decision.reason} ({where})") if where else decision

    detail: Detail = "full" if any(each is None for each in without_value) else "status"
    verdict = verdict_by(criterion, bounds_of(criterion), decide_by, detail=detail)
    stated = criterion.definition.stated()
    return replace(verdict, over_stops=over_stops(decisions(criterion, stated)))
