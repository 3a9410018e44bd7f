"""Run one case: simulate it, judge it, and record it if requested."""

from __future__ import annotations

import traceback
from dataclasses import dataclass, replace
from time import perf_counter
from typing import Literal

from uictest import rig
from uictest.controllers import ControllerError
from uictest.core.recording import Recording
from uictest.judging import evaluation
from uictest.plans import scenario
from uictest.rig import bench


@dataclass(frozen=True, slots=True)
class RecordingRequest:
    """Cases to record (`failed`: those that miss their expectation), and the interval of samples, s."""

    cases: Literal["all", "failed", "none"] = "failed"
    every: float = 0.01

    def wants(self, result: evaluation.CaseResult) -> bool:
        """Return whether to record a case with this result."""
        return self.cases == "all" or (self.cases == "failed" and not result.met)


@dataclass(frozen=True, slots=True)
class CaseRun:
    """A case's result, the recording of its stop if there is one, and the traceback of a crash."""

    result: evaluation.CaseResult
    recording: Recording | None = None
    traceback: str = ""


def run_case(case: scenario.Case, request: RecordingRequest, run: rig.RunInputs | None = None) -> CaseRun:
    """Simulate and judge one stop of a case, that of its own seed.

    An exception becomes a result with the outcome `error`. `run` runs the stop, see
    :func:`uictest.rig.simulate`.
    """
    started = perf_counter()
    try:
        return _simulate_and_judge(case, request, started, run)
    except Exception as error:
        return failed_run(case, error, perf_counter() - started)


def failed_run(case: scenario.Case, error: Exception, duration: float) -> CaseRun:
    """Return the result of a stop that ended in an exception after so many seconds: outcome `error`."""
    result = evaluation.error_result(case, _reason(error), duration)
    if isinstance(error, ControllerError):
        result = replace(result, case_sha256=rig.sha256_of_case(case))
    return CaseRun(result, traceback="".join(traceback.format_exception(error)))


def _simulate_and_judge(
    case: scenario.Case, request: RecordingRequest, started: float, run: rig.RunInputs | None
) -> CaseRun:
    case = bench.identified(case)
    # A controller from outside may answer differently when its stop is repeated.
    from_outside = case.scenario.controller.program is not None
    at_once = request.cases == "all" or (request.cases == "failed" and from_outside)
    stop: rig.SimulatedStop = rig.simulate(case, request.every if at_once else None, run)
    result = evaluation.evaluate_simulated(
        *(case, stop.measures, stop.wheelset_measures, perf_counter() - started),
        response_times=stop.response_times,
    )
    result = replace(
        result,
        controller_version=stop.controller_version,
        case_sha256=stop.case_sha256,
        noise_key=stop.noise_key,
    )
    if not request.wants(result):
        return CaseRun(result)
    if not at_once:
        # A stop is reproducible to the bit, so it can be recorded once the case is known to have missed.
        stop = rig.simulate(case, request.every, run)
    return CaseRun(result, stop.recording)


def _reason(error: Exception) -> str:
    if isinstance(error, ControllerError):
        return f"controller: {error}"
    return f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
