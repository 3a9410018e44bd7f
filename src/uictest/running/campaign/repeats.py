"""Cases as the stops they consist of: each stop is run by itself, and those of a case are put together."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from time import perf_counter
from typing import NamedTuple

from uictest import rig
from uictest.core.recording import Recording
from uictest.judging import evaluation
from uictest.plans import scenario
from uictest.rig import bench
from uictest.running.campaign.case import CaseRun, RecordingRequest, failed_run


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
