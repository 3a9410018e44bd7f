"""From a case and what was measured in it to its result."""

from __future__ import annotations

from typing import TYPE_CHECKING

from uictest.evaluation.adhesion import DEFAULT_FIRST_PHASE
from uictest.evaluation.coverage import Coverage
from uictest.evaluation.figures import (
    figures_of,
    known_figures,
    known_wheelset_figures,
    wheelset_figures_of,
)
from uictest.evaluation.judgement import judge
from uictest.evaluation.outcome import outcome_of
from uictest.evaluation.records import StopMeasures, Wheelsets
from uictest.evaluation.result import CaseResult

if TYPE_CHECKING:
    from uictest.scenario import Case, Scenario


JUDGED_KEYS = (
    "brake.position",
    "brake.command",
    "rail.condition",
    "rail.gradient",
    "rig.topology",
    "rig.wsp",
    "simulation.maximum_duration",
    "criteria",
    "measures",
    "expect",
)
"""Keys of a scenario at or below which :func:`evaluate` reads; all else reaches it through the measures."""


def evaluate(
    case: Case,
    measures: StopMeasures,
    wheelset_measures: Wheelsets,
    duration: float = 0.0,
    *,
    explain: bool = True,
    coverage: Coverage | None = None,
) -> CaseResult:
    """Return the judged result of a case whose stop was simulated or measured.

    Args:
        case: what was to be done.
        measures: record of the stop, SI.
        wheelset_measures: one record per wheelset from the leading end, SI.
        duration: wall clock the simulation took, s.
        explain: as for :func:`judge`.
        coverage: as for :func:`judge`.

    """
    verdicts = judge(case.scenario, measures, wheelset_measures, explain=explain, coverage=coverage)
    outcome, reason = outcome_of(verdicts)
    figures = figures_of(measures, _first_phase_duration(case.scenario))
    wheelsets = [wheelset_figures_of(wheelset) for wheelset in wheelset_measures]
    if coverage is not None:
        figures = known_figures(figures, coverage)
        wheelsets = [known_wheelset_figures(each, coverage) for each in wheelsets]
    return CaseResult(
        id=case.id,
        scenario=case.path.as_posix(),
        parameters=dict(case.parameters),
        expect=case.scenario.expect,
        outcome=outcome,
        criteria=tuple(verdicts),
        measures=figures,
        wheelsets=tuple(wheelsets),
        reason=reason,
        duration=duration,
    )


def error_result(case: Case, reason: str, duration: float = 0.0) -> CaseResult:
    """Return the result of a case whose simulation failed: outcome `error`, why, and nothing judged."""
    return CaseResult(
        id=case.id,
        scenario=case.path.as_posix(),
        parameters=dict(case.parameters),
        expect=case.scenario.expect,
        outcome="error",
        reason=reason,
        duration=duration,
    )


def _first_phase_duration(scenario: Scenario) -> float:
    """Return the first phase (s) of the first criterion that defines one: figure and verdict agree."""
    for profile in scenario.criteria:
        for criterion in profile.criteria:
            if criterion.definition.first_phase_duration is not None:
                return float(criterion.definition.first_phase_duration.value)
    return DEFAULT_FIRST_PHASE
