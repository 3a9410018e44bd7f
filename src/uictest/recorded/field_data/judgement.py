"""A recorded stop judged by the code that judges simulated ones."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

from uictest.core.recording import BRAKE_COMMAND_TIME, Recording
from uictest.judging.evaluation import CaseResult, error_result, evaluate
from uictest.plans import scenario
from uictest.recorded.field_data.defect import Defect
from uictest.recorded.field_data.observation import Observed, observe
from uictest.recorded.field_data.recorded_stop import RecordedStop


def judge_recording(case: scenario.Case, stop: RecordedStop) -> tuple[CaseResult, Recording]:
    """Return the result of a recorded stop under the conditions and criteria of a case, and its recording.

    The definition of every verdict states how the record was prepared and what is wrong with it. The
    recording carries the metadata that a simulated one has.
    """
    observed = observe(stop, case.scenario)
    result = evaluate(case, observed.measures, observed.wheelset_measures, coverage=observed.coverage)
    preparation = {**stop.choices, **_defects(stop.defects)}
    criteria = tuple(
        replace(verdict, definition={**verdict.definition, **preparation}) for verdict in result.criteria
    )
    recording = replace(stop.recording, metadata=dict(_metadata(case, stop, observed)))
    return replace(result, criteria=criteria), recording


def _metadata(case: scenario.Case, stop: RecordedStop, observed: Observed) -> Iterator[tuple[str, str]]:
    yield "case", case.id
    if not stop.trigger.late:
        yield BRAKE_COMMAND_TIME, "0 s"
    known = "initial_adhesion" not in observed.coverage.missing
    if known and math.isfinite(observed.measures.sliding_time):
        yield "sliding_time", f"{observed.measures.sliding_time:.6g}"


def unusable_result(case: scenario.Case, defects: tuple[Defect, ...]) -> CaseResult:
    """Return the result of a record that cannot be used at all: an error that names every defect."""
    return error_result(case, "; ".join(map(str, defects)))


def _defects(defects: tuple[Defect, ...]) -> dict[str, str]:
    return {"defects": "; ".join(map(str, defects))} if defects else {}
