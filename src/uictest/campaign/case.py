"""One case from scenario to result: simulated, judged, and where it is worth it recorded."""

from __future__ import annotations

import traceback
from dataclasses import dataclass
from time import perf_counter
from typing import TYPE_CHECKING, Literal

from uictest import evaluation, rig, scenario

if TYPE_CHECKING:
    from uictest.recording import Recording


@dataclass(frozen=True, slots=True)
class RecordingRequest:
    """Which cases are recorded (`failed`: those that miss their expectation), and every how many seconds."""

    cases: Literal["all", "failed", "none"] = "failed"
    every: float = 0.01

    def wants(self, result: evaluation.CaseResult) -> bool:
        """Return whether a case that came out like this is to be recorded."""
        return self.cases == "all" or (self.cases == "failed" and not result.met)


@dataclass(frozen=True, slots=True)
class CaseRun:
    """A case's result, the recording of its stop where it was wanted, and the traceback of a crash."""

    result: evaluation.CaseResult
    recording: Recording | None = None
    traceback: str = ""


def run_case(case: scenario.Case, wish: RecordingRequest) -> CaseRun:
    """Simulate and judge one case. Whatever goes wrong inside becomes a result with the outcome `error`."""
    started = perf_counter()
    try:
        return _examine(case, wish, started)
    except Exception as error:
        result = evaluation.error_result(case, _reason(error), perf_counter() - started)
        return CaseRun(result, traceback=traceback.format_exc())


def _examine(case: scenario.Case, wish: RecordingRequest, started: float) -> CaseRun:
    stop: rig.SimulatedStop = rig.simulate(case, record_every=wish.every if wish.cases == "all" else None)
    result = evaluation.evaluate_simulated(
        case, stop.measures, stop.wheelset_measures, perf_counter() - started
    )
    if wish.cases == "failed" and not result.met:
        # A stop repeats itself exactly, so a recording can be taken once the case has proved worth one.
        stop = rig.simulate(case, record_every=wish.every)
    return CaseRun(result, stop.recording)


def _reason(error: Exception) -> str:
    return f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
