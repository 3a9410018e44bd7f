"""Whether the rail makes a stop a test: the validity of the same stop with the WSP bypassed."""

from __future__ import annotations

from dataclasses import replace

from uictest.core.measures import StopMeasures, Wheelsets
from uictest.judging.evaluation.judgement import judge
from uictest.judging.evaluation.result import CaseResult
from uictest.judging.evaluation.statements import RailValidity, decided_by, outcome_of
from uictest.plans import scenario


def asks_for_rail(case: scenario.Case, result: CaseResult) -> bool:
    """Return whether the rail is to be looked at: it decides, or the stop with its WSP is no test.

    On a dry rail the WSP has no part in that.
    """
    of_validity = [each for each in result.criteria if each.layer == "validity" and each.value is not None]
    missed = any(each.status == "fail" for each in of_validity)
    resolved = case.scenario
    if not (missed or (of_validity and resolved.test_validity == "rail")):
        return False
    return resolved.rig.wsp == "active" and resolved.drag is None and resolved.rail.condition.name != "dry"


def with_rail(
    result: CaseResult, case: scenario.Case, measures: StopMeasures, wheelset_measures: Wheelsets
) -> CaseResult:
    """Return a result with the validity of the rail, which decides where the scenario says so.

    Args:
        result: of the stop with the WSP active.
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
