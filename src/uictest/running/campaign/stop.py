"""One stop of a case, or the stops of a train, simulated and judged; the stops of a case, put together."""

from __future__ import annotations

import traceback
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from itertools import groupby
from time import perf_counter
from typing import Any, Final, Literal, NamedTuple

from uictest import report, rig
from uictest.controllers import DEFAULT, ControllerError
from uictest.core.recording import Recording
from uictest.judging import evaluation
from uictest.plans import scenario
from uictest.plans.scenario.yaml import Part
from uictest.rig import bench


class RecordingRequest(NamedTuple):
    """Cases to record (`failed`: those that miss their expectation), and the interval of samples, s.

    Of a repeated case the first stop is recorded; of so many `band_stops` the extremes over time are kept.
    `keep_output` takes the id of a case and what its controller printed, and returns where that lies.
    """

    cases: Literal["all", "failed", "none"] = "failed"
    every: float = 0.01
    band_stops: int = 0
    keep_output: Callable[[str, str], str] | None = None

    def wants(self, result: evaluation.CaseResult) -> bool:
        """Return whether to record a case with this result."""
        return self.cases == "all" or (self.cases == "failed" and not result.met)

    def among(
        self, recordings: Mapping[str, Recording], results: Iterable[evaluation.CaseResult]
    ) -> dict[str, Recording]:
        """Return those of some recordings, by id, whose cases are to be recorded."""
        wanted = {result.id for result in results if self.wants(result)}
        return {name: samples for name, samples in recordings.items() if name in wanted}


class CaseRun(NamedTuple):
    """A case's result, the recording of its stop if there is one, and the traceback of a crash.

    `extremes` are those of the first stops of a repeated case, `output` what its controller printed.
    """

    result: evaluation.CaseResult
    recording: Recording | None = None
    traceback: str = ""
    extremes: tuple[report.StopExtremes, ...] = ()
    output: str = ""


class Stop(NamedTuple):
    """One stop of a case; `repeat` counts the stops of the case from 0."""

    case: scenario.Case
    repeat: int = 0

    @property
    def seed(self) -> int:
        """The seed of the stop."""
        return self.case.scenario.seed + self.repeat

    @property
    def is_repeated(self) -> bool:
        """Whether its case has further stops."""
        return self.case.scenario.repeat > 1

    @property
    def alone(self) -> scenario.Case:
        """The case that is this stop alone: under the same name, with its own seed."""
        return self.case.with_values(seed=self.seed, repeat=1) if self.is_repeated else self.case


class StopRun(NamedTuple):
    """A stop and its result; where its case repeats it, with the records that all stops are judged by."""

    stop: Stop
    case_run: CaseRun
    records: tuple[Any, ...] = ()


def trains_in(cases: Iterable[scenario.Case]) -> Iterator[tuple[scenario.Case, ...]]:
    """Yield the cases that run at once: one alone, or neighbours that are cars of one train."""

    def stop(case: scenario.Case) -> Hashable:
        return id(case) if case.train is None else (case.train.train, case.scenario.seed)

    for _, neighbours in groupby(cases, stop):
        yield tuple(neighbours)


def stops_of(cases: Iterable[scenario.Case]) -> Iterator[Stop]:
    """Yield every stop of every case, in order of cases and seeds."""
    for case in cases:
        yield from (Stop(case, repeat) for repeat in range(case.scenario.repeat))


def stops_together(cases: Iterable[scenario.Case]) -> Iterator[tuple[Stop, ...]]:
    """Yield the stops that run at once, in order of cases and seeds: one alone, or those of a train."""
    for cars in trains_in(cases):
        for repeat in range(cars[0].scenario.repeat):
            yield tuple(Stop(case, repeat) for case in cars)


def run_stop(stop: Stop, request: RecordingRequest, run: rig.RunInputs | None = None) -> StopRun:
    """Simulate and judge one stop. An exception becomes a result with the outcome `error`.

    `run` runs the stop, see :func:`uictest.rig.simulate`. Of the stops of a case only the first is recorded,
    and of those of the band the extremes are kept.
    """

    def simulated(cases: Sequence[scenario.Case], every: float | None) -> list[rig.SimulatedStop]:
        return [rig.simulate(case, every, run) for case in cases]

    return _run_at_once([stop], request, simulated)[0]


def run_train(
    stops: Sequence[Stop], request: RecordingRequest, run: rig.RunTrain | None = None
) -> list[StopRun]:
    """Simulate a train once, and judge the stops of some of its cars as :func:`run_stop` does."""

    def simulated(cases: Sequence[scenario.Case], every: float | None) -> list[rig.SimulatedStop]:
        return rig.simulate_cars(cases, every, run)

    return _run_at_once(stops, request, simulated)


def run_trains(
    trains: Sequence[Sequence[Stop]], request: RecordingRequest, run: rig.RunTrain | None = None
) -> list[StopRun]:
    """Simulate trains, none of them recorded at once, and judge as :func:`run_train` does.

    Those whose controllers are built in run side by side, the others one after the other with `run`.
    """
    built_in = [stops for stops in trains if not stops[0].case.is_from_outside]
    in_lanes = iter(_run_in_lanes(built_in, request) if built_in else ())
    runs: list[StopRun] = []
    for stops in trains:
        runs += run_train(stops, request, run) if stops[0].case.is_from_outside else next(in_lanes)
    return runs


def _run_in_lanes(trains: Sequence[Sequence[Stop]], request: RecordingRequest) -> list[list[StopRun]]:
    started = perf_counter()
    try:
        cases = [[bench.identified(stop.alone) for stop in stops] for stops in trains]
        simulated = rig.simulate_trains(cases)
    except Exception:  # which train it is shows when they run one by one
        return [run_train(stops, request) for stops in trains]
    seconds = (perf_counter() - started) / len(trains)

    def judged(stops: Sequence[Stop], simulated_cars: list[rig.SimulatedStop]) -> list[StopRun]:
        def simulate(cases: Sequence[scenario.Case], every: float | None) -> list[rig.SimulatedStop]:
            return simulated_cars if every is None else rig.simulate_cars(cases, every)

        return _run_at_once(stops, request, simulate, seconds)

    return list(map(judged, trains, simulated))


def _run_at_once(
    stops: Sequence[Stop],
    request: RecordingRequest,
    simulate: Callable[[Sequence[scenario.Case], float | None], list[rig.SimulatedStop]],
    spent: float = 0.0,
) -> list[StopRun]:
    """Return the runs of stops that are simulated at once; `spent`: seconds that they have taken before."""
    started = perf_counter() - spent
    cases = [stop.alone for stop in stops]
    try:
        cases = [bench.identified(case) for case in cases]
        simulated = simulate(cases, interval_at_once(stops[0], request))
        seconds = (perf_counter() - started) / len(stops)
        results = [_judged_result(*of_car, seconds) for of_car in zip(stops, cases, simulated, strict=True)]
        results = with_rails(cases, results)
        # A stop is reproducible to the bit, so it can be recorded once the case is known to have missed.
        if not stops[0].is_repeated and simulated[0].recording is None and any(map(request.wants, results)):
            simulated = simulate(cases, request.every)
        return [_finished_run(*of_car, request) for of_car in zip(stops, results, simulated, strict=True)]
    except Exception as error:
        seconds = (perf_counter() - started) / len(stops)
        failed = [_failed_run(case, error, seconds) for case in cases]
        return [StopRun(stop, case_run) for stop, case_run in zip(stops, failed, strict=True)]


def _judged_result(
    stop: Stop, case: scenario.Case, simulated: rig.SimulatedStop, seconds: float
) -> evaluation.CaseResult:
    result = evaluation.evaluate_simulated(
        *(case, simulated.measures, simulated.wheelset_measures, seconds),
        detail="status" if stop.is_repeated else "full",
        response_times=simulated.response_times,
        couplers=(simulated.coupler_ahead, simulated.coupler_behind),
    )
    return replace(
        result,
        controller_version=simulated.controller_version,
        controller_contract=simulated.controller_contract,
        case_sha256=simulated.case_sha256,
        noise_key=simulated.noise_key,
    )


def with_rails(
    cases: Sequence[scenario.Case], results: Sequence[evaluation.CaseResult]
) -> list[evaluation.CaseResult]:
    """Return the results of a stop, or of the cars of a train, with the validity of the rail where asked.

    The stop is run again under its seed, with the WSP bypassed: of a train, that of every car.
    """
    asked = [evaluation.asks_for_rail(*each) for each in zip(cases, results, strict=True)]
    if not any(asked):
        return list(results)
    bypassed = [case.changed(_with_wsp_bypassed) for case in cases]
    if cases[0].train is not None:
        stops = rig.simulate_cars(bypassed, None)
    else:
        stops = [rig.simulate(case, None) for case in bypassed]
    return [
        evaluation.with_rail(result, case, stop.measures, stop.wheelset_measures) if wanted else result
        for wanted, case, result, stop in zip(asked, cases, results, stops, strict=True)
    ]


def _with_wsp_bypassed(resolved: scenario.Scenario) -> scenario.Scenario:
    """Return a scenario with the WSP bypassed; no program from outside runs where it would not act."""
    bypassed = scenario.with_wsp_bypassed(resolved)
    if resolved.controller.program is None:
        return bypassed
    own = {"cycle_time": resolved.controller.cycle_time}
    return bypassed.model_copy(update={"controller": _built_in().model_copy(update=own)})


@cache
def _built_in() -> Part:
    return scenario.load_part(f"controllers/{DEFAULT}")


def _finished_run(
    stop: Stop, result: evaluation.CaseResult, simulated: rig.SimulatedStop, request: RecordingRequest
) -> StopRun:
    """Return a judged stop; the first of a repeated case has a recording, which says that it is the first."""
    case_run, samples = CaseRun(result, output=simulated.controller_output), simulated.recording
    if not stop.is_repeated:
        return StopRun(stop, case_run._replace(recording=samples if request.wants(result) else None))
    if samples is not None and stop.repeat < request.band_stops:
        case_run = case_run._replace(extremes=(report.stop_extremes(samples),))
    if samples is not None and stop.repeat == 0:
        which = f"{stop.seed}, the first of {stop.case.scenario.repeat} stops"
        first = replace(samples, metadata={**samples.metadata, "seed": which})
        case_run = case_run._replace(recording=first)
    records = (simulated.measures, simulated.wheelset_measures) if result.outcome != "error" else ()
    return StopRun(stop, case_run, records)


def interval_at_once(stop: Stop, request: RecordingRequest) -> float | None:
    """Return the interval of samples of a stop that is recorded at once, s; None if it is not.

    A controller from outside may answer differently when its stop is repeated; and whether a repeated case
    misses its expectation is known when all of its stops are there.
    """
    if stop.is_repeated:
        at_once = stop.repeat < max(request.band_stops, 1)
    else:
        at_once = request.cases == "all" or stop.case.is_from_outside
    return request.every if at_once and request.cases != "none" else None


def _failed_run(case: scenario.Case, error: Exception, duration: float) -> CaseRun:
    reason = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
    of_controller = isinstance(error, ControllerError)
    result = evaluation.error_result(case, f"controller: {error}" if of_controller else reason, duration)
    if of_controller:
        result = replace(result, case_sha256=rig.sha256_of_case(case))
    return CaseRun(result, None, "".join(traceback.format_exception(error)), (), getattr(error, "output", ""))


@dataclass(slots=True)
class CaseAssembly:
    """Puts the stops of cases together, in whatever order they finish."""

    request: RecordingRequest
    _runs: dict[str, dict[int, StopRun]] = field(default_factory=dict)

    def add(self, run: StopRun) -> None:
        """Add a stop that is finished."""
        self._runs.setdefault(run.stop.case.id, {})[run.stop.repeat] = run

    def complete(self) -> Iterator[CaseRun]:
        """Yield the cases all of whose stops are there, each once."""
        for case_id, runs in list(self._runs.items()):
            if len(runs) == next(iter(runs.values())).stop.case.scenario.repeat:
                case_run = self._with_log(
                    self._case_run_of_repeats([runs[repeat] for repeat in sorted(runs)])
                )
                # Not before: an interrupt while the stops are judged does not lose them.
                del self._runs[case_id]
                yield case_run

    def _case_run_of_repeats(self, runs: Sequence[StopRun]) -> CaseRun:
        stop, first = runs[0].stop, runs[0].case_run
        if not stop.is_repeated:
            return first
        repeats = [
            evaluation.SimulatedRepeat(run.stop.seed, run.case_run.result, *run.records) for run in runs
        ]
        result = evaluation.evaluate_repeats(stop.case, repeats)
        crash = next((text for run in runs if (text := run.case_run.traceback)), "")
        recording = first.recording if self.request.wants(result) else None
        extremes = tuple(extreme for run in runs for extreme in run.case_run.extremes)
        printed = {run.stop.seed: run.case_run.output for run in runs if run.case_run.output}
        output = "".join(f"--- seed {seed}\n{text}" for seed, text in printed.items())
        return CaseRun(result, recording, crash, extremes, output)

    def _with_log(self, run: CaseRun) -> CaseRun:
        keep = self.request.keep_output
        log = keep(run.result.id, run.output) if keep and run.output else ""
        return run._replace(result=replace(run.result, controller_log=log)) if log else run


_MOST_TOGETHER: Final = 32
"""Trains that a thread simulates in one queue; chosen: four times what the widest registers hold."""

Block = Sequence[Sequence[Stop]]
"""Stops that run at once, one alone or those of the cars of a train; or several trains."""


def blocks_of(cases: Sequence[scenario.Case], request: RecordingRequest, jobs: int) -> Iterator[Block]:
    """Yield groups of stops that a thread runs in one go, in order of cases and seeds."""
    trains = sum(_can_run_in_lane(stops, request) for stops in stops_together(cases))
    # As many for each thread: at the end of the longest all others wait.
    rounds = -(-trains // (_MOST_TOGETHER * jobs))
    size = -(-trains // (rounds * jobs)) if trains else 1
    for fits, neighbours in groupby(stops_together(cases), lambda stops: _can_run_in_lane(stops, request)):
        together, step = list(neighbours), size if fits else 1
        yield from (together[first : first + step] for first in range(0, len(together), step))


def run_block(
    block: Block,
    request: RecordingRequest,
    run: rig.RunInputs | None = None,
    run_of_train: rig.RunTrain | None = None,
) -> list[StopRun]:
    """Simulate and judge what runs in one go.

    `run` runs stops of cars alone, see :func:`.run_stop`, and `run_of_train` those of trains.
    """
    if len(block) > 1:
        return run_trains(block, request)
    (stops,) = block
    if stops[0].case.train is not None:
        return run_train(stops, request, run_of_train)
    return [run_stop(stop, request, run) for stop in stops]


def _can_run_in_lane(stops: Sequence[Stop], request: RecordingRequest) -> bool:
    """Return whether stops can run in a lane: of a train with built-in controllers, none of them recorded."""
    first = stops[0]
    is_in_train = first.case.train is not None and not first.case.is_from_outside
    return is_in_train and interval_at_once(first, request) is None
