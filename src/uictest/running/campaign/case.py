"""Run one case: simulate it, judge it, record it; the stops of a case that repeats its stop."""

from __future__ import annotations

import traceback
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from time import perf_counter
from typing import Literal, NamedTuple

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


class Stop(NamedTuple):
    """One stop of a case; `place` counts its seeds from 0."""

    case: scenario.Case
    place: int

    @property
    def seed(self) -> int:
        """The seed of the stop."""
        return self.case.scenario.seed + self.place


@dataclass(frozen=True, slots=True)
class StopRun:
    """A stop and its result, with the recording of the first one of a case, or a traceback.

    `repeat` is None for a case with one stop, whose result is then that of the case.
    """

    stop: Stop
    case_run: CaseRun
    repeat: evaluation.SimulatedRepeat | None = None


def stops_of(cases: Iterable[scenario.Case]) -> Iterator[Stop]:
    """Yield every stop of every case, in order of cases and seeds."""
    for case in cases:
        yield from (Stop(case, place) for place in range(case.scenario.repeat))


def case_of_stop(stop: Stop) -> scenario.Case:
    """Return the case that is this stop alone: under the same name, with its own seed."""
    changes = {"seed": stop.seed, "repeat": 1}
    return replace(stop.case, scenario=stop.case.scenario.model_copy(update=changes))


def run_repeat(stop: Stop, request: RecordingRequest, run: rig.RunInputs | None = None) -> StopRun:
    """Simulate and judge one stop of a repeated case. An exception becomes a result, outcome `error`.

    Only the first stop is recorded, and at once: whether its case misses its expectation is known later.
    """
    started = perf_counter()
    case = case_of_stop(stop)
    every = request.every if stop.place == 0 and request.cases != "none" else None
    try:
        case = bench.identified(case)
        simulated: rig.SimulatedStop = rig.simulate(case, every, run)
        records = simulated.measures, simulated.wheelset_measures
        result = evaluation.evaluate_simulated(case, *records, perf_counter() - started, explain=False)
    except Exception as error:
        failed = failed_run(case, error, perf_counter() - started)
        return StopRun(stop, failed, evaluation.SimulatedRepeat(stop.seed, failed.result))
    result = replace(
        result,
        controller_version=simulated.controller_version,
        case_sha256=simulated.case_sha256,
        noise_key=simulated.noise_key,
    )
    judged = records if result.outcome != "error" else ()
    repeat = evaluation.SimulatedRepeat(stop.seed, result, *judged)
    return StopRun(stop, CaseRun(result, _with_seed(simulated.recording, stop)), repeat)


def _with_seed(samples: Recording | None, stop: Stop) -> Recording | None:
    """Return a recording that says which of the stops of its case it is."""
    if samples is None:
        return None
    which = f"{stop.seed}, the first of {stop.case.scenario.repeat} stops"
    return replace(samples, metadata={**samples.metadata, "seed": which})


@dataclass(slots=True)
class CaseAssembly:
    """Puts the stops of cases together, in whatever order they finish."""

    request: RecordingRequest
    _runs: dict[str, dict[int, StopRun]] = field(default_factory=dict)

    def add(self, run: StopRun) -> None:
        """Add a stop that is finished."""
        self._runs.setdefault(run.stop.case.id, {})[run.stop.place] = run

    def complete(self) -> Iterator[CaseRun]:
        """Yield the cases all of whose stops are there, each once."""
        for case_id, runs in list(self._runs.items()):
            case = next(iter(runs.values())).stop.case
            if len(runs) == case.scenario.repeat:
                case_run = self._together(case, [runs[place] for place in sorted(runs)])
                # Not before: an interrupt while the stops are judged does not lose them.
                del self._runs[case_id]
                yield case_run

    def _together(self, case: scenario.Case, runs: Sequence[StopRun]) -> CaseRun:
        repeats = [run.repeat for run in runs if run.repeat is not None]
        first = runs[0].case_run
        if not repeats:
            return first
        result = evaluation.evaluate_repeats(case, repeats)
        traceback = next((text for run in runs if (text := run.case_run.traceback)), "")
        return CaseRun(result, first.recording if self.request.wants(result) else None, traceback)
