"""The parts that cases are run with, computed from their scenarios."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from uictest.judging import evaluation
from uictest.plans import scenario
from uictest.rig import bench
from uictest.running.campaign.case import CaseRun

PartsOfCases = Mapping[str, Mapping[str, "evaluation.EffectivePart"]]
"""Case id -> role -> part."""


def parts_of_cases(cases: Sequence[scenario.Case]) -> PartsOfCases:
    """Return the parts of simulated stops; a part that many cases share is computed once.

    A compensation that is to be identified is: those parts are what the stop is run with.
    """
    effective = evaluation.EffectiveParts()
    return {case.id: effective.of(_as_run(case).scenario) for case in cases}


def _as_run(case: scenario.Case) -> scenario.Case:
    try:
        return bench.identified(case)
    except ValueError:  # nothing can be identified: the stop says why
        return case


def parts_of_recorded(cases: Sequence[scenario.Case]) -> PartsOfCases:
    """Return the parts that recorded stops are judged with: conditions, measures and criteria, no rig."""
    effective = evaluation.EffectiveParts()
    return {case.id: effective.of_recorded(case.scenario) for case in cases}


def with_parts(case_run: CaseRun, parts: PartsOfCases) -> CaseRun:
    """Return the run of a case with its parts in the result."""
    result = case_run.result
    return replace(case_run, result=replace(result, parts=parts.get(result.id, {})))


def with_domain(case_run: CaseRun, domains: Mapping[str, evaluation.DomainOfValidity]) -> CaseRun:
    """Return the run of a case with what is known of it and of the domain of a validation in the result."""
    result = case_run.result
    return replace(case_run, result=replace(result, domain_of_validity=domains.get(result.id)))
