"""A recorded stop judged by the code that judges simulated ones."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

from uictest import scenario
from uictest.evaluation import CaseResult, error_result, evaluate
from uictest.field_data.defect import Defect
from uictest.field_data.observation import Observed, observe
from uictest.field_data.prepare import RecordedStop
from uictest.recording import BRAKE_COMMAND_TIME, Recording


def judge_stop(case: scenario.Case, stop: RecordedStop) -> CaseResult:
    """Return the result of a recorded stop under the circumstances and criteria of a case."""
    result, _ = judge_recording(case, stop)
    return result


def judge_recording(case: scenario.Case, stop: RecordedStop) -> tuple[CaseResult, Recording]:
    """Return the result of a recorded stop, and its recording with the facts that a simulated one states.

    How the record was prepared, and what was found wrong with it, stand in the definition of every verdict.
    """
    observed = observe(stop, case.scenario.measures)
    result = evaluate(case, observed.measures, observed.wheelset_measures, coverage=observed.coverage)
    told = {**stop.choices, **_defects(stop.defects)}
    result = replace(
        result, criteria=tuple(replace(v, definition={**v.definition, **told}) for v in result.criteria)
    )
    return result, replace(stop.recording, metadata=dict(_facts(case, stop, observed)))


def _facts(case: scenario.Case, stop: RecordedStop, observed: Observed) -> Iterator[tuple[str, str]]:
    yield "case", case.id
    if not stop.trigger.late:
        yield BRAKE_COMMAND_TIME, "0 s"
    known = "initial_adhesion" not in observed.coverage.missing
    if known and math.isfinite(observed.measures.sliding_time):
        yield "sliding_time", f"{observed.measures.sliding_time:.6g}"


def unusable_result(case: scenario.Case, defects: tuple[Defect, ...]) -> CaseResult:
    """Return the result of a record that cannot be measured at all: an error that names every defect."""
    return error_result(case, "; ".join(map(str, defects)))


def _defects(defects: tuple[Defect, ...]) -> dict[str, str]:
    return {"defects": "; ".join(map(str, defects))} if defects else {}
