"""A recorded stop judged by the code that judges simulated ones."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from uictest.evaluation import CaseResult, error_result, evaluate
from uictest.measured.defect import Defect
from uictest.measured.observation import observe
from uictest.measured.prepare import MeasuredStop

if TYPE_CHECKING:
    from uictest.scenario import Case


def judge_stop(case: Case, stop: MeasuredStop) -> CaseResult:
    """Return the result of a recorded stop under the circumstances and criteria of a case.

    How the record was prepared, and what was found wrong with it, stand in the definition of every verdict.
    """
    observed = observe(stop, case.scenario.measures)
    result = evaluate(case, observed.measures, observed.wheelset_measures, coverage=observed.coverage)
    told = {**stop.choices, **_defects(stop.defects)}
    return replace(
        result, criteria=tuple(replace(v, definition={**v.definition, **told}) for v in result.criteria)
    )


def unusable_result(case: Case, defects: tuple[Defect, ...]) -> CaseResult:
    """Return the result of a record that cannot be measured at all: an error that names every defect."""
    return error_result(case, "; ".join(map(str, defects)))


def _defects(defects: tuple[Defect, ...]) -> dict[str, str]:
    return {"defects": "; ".join(map(str, defects))} if defects else {}
