"""The parts that cases are run with, computed from their scenarios."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from uictest.campaign.examination import Examined

if TYPE_CHECKING:
    from uictest.evaluation import EffectivePart
    from uictest.scenario import Case

PartsOfCases = Mapping[str, Mapping[str, "EffectivePart"]]
"""Case id -> role -> part."""


def parts_of_cases(cases: Sequence[Case]) -> PartsOfCases:
    """Return the parts of simulated stops; a part that many cases share is computed once."""
    from uictest.evaluation.effective_parts import EffectiveParts

    effective = EffectiveParts()
    return {case.id: effective.of(case.scenario) for case in cases}


def parts_of_recorded(cases: Sequence[Case]) -> PartsOfCases:
    """Return what recorded stops are judged under: conditions, measures and criteria, nothing of a rig."""
    from uictest.evaluation.effective_parts import EffectiveParts

    effective = EffectiveParts()
    return {case.id: effective.of_recorded(case.scenario) for case in cases}


def with_parts(examined: Examined, parts: PartsOfCases) -> Examined:
    """Return an examined case whose result carries its parts."""
    result = examined.result
    return replace(examined, result=replace(result, parts=parts.get(result.id, {})))
