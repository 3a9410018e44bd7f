"""What one criterion says of the stops of a repeated case together, by the rule of the case."""

from __future__ import annotations

import math
import statistics
from collections.abc import Sequence
from dataclasses import dataclass

from uictest.core.units import value_text, with_unit
from uictest.judging.evaluation.bounds import Bounds
from uictest.judging.evaluation.decision import Decision
from uictest.judging.evaluation.repeats import Rule, stops_needed
from uictest.judging.evaluation.verdict import OverStops, Status


@dataclass(frozen=True, slots=True)
class OutcomeRule:
    """A rule with the share of stops that must come out alike, from 0 to 1; `median` asks for none."""

    name: Rule
    share: float = 1.0

    def needed(self, stops: int) -> int:
        """Return how many of so many stops that is."""
        return stops_needed(self.share, stops)


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
