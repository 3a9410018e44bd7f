"""Many stops at once, assembled and judged one by one: of cases, of one varied case, of one train."""

from __future__ import annotations

from collections import namedtuple
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, ClassVar, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest import rig
from uictest.controllers import ControllerError
from uictest.core.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.judging.evaluation import (
    CaseResult,
    Detail,
    asks_for_rail,
    error_result,
    evaluate_simulated,
    may_be_biased,
    with_rail,
)
from uictest.plans.scenario import Case, Scenario
from uictest.plans.scenario.yaml import dotted
from uictest.plans.sweeps import Column, in_survey_step, inconsistencies, train_problem, with_values
from uictest.rig import bench
from uictest.rig.identification import UnsuitableRecordError
from uictest.running.campaign import ThreadedMap
from uictest.running.chunked.table import biases_by_measure

RunBlock = Callable[[rig.BlockInputs], rig.BlockRun]
"""Simulates stops, some with controllers from outside: in this process, or in child processes."""
Simulate = Callable[[NDArray[Any], NDArray[Any], NDArray[np.float64]], tuple[NDArray[Any], NDArray[Any]]]
"""Simulates n stops: parameters (n,), those of wheelsets (n, 4) and friction laws (n, 4, points) to measures
(n,) and measures of wheelsets (n, 4)."""
# Judging reads many fields, and a numpy record takes ten times as long to read as a tuple.
_tuple_of: Any = namedtuple
_Measures: Final = _tuple_of("_Measures", STOP_MEASURES.names)
_WheelsetMeasures: Final = _tuple_of("_WheelsetMeasures", WHEELSET_MEASURES.names)


class PlannedCase(NamedTuple):
    """A case of a sweep; `problem` says why it cannot be simulated, empty where nothing is known."""

    case: Case
    problem: str = ""


def no_such_key(error: KeyError) -> str:
    """Return the reason why a case with a value for a key that another value removes cannot be simulated."""
    return f"{error.args[0]!r}: no such key beside the other values of this case"


class _Simulated(NamedTuple):
    """Result of one stop: its measures, or the reason why there are none."""

    measures: Any = None
    wheelset_measures: Sequence[Any] = ()
    problem: str = ""


@dataclass(frozen=True)
class ManyStops:
    """Simulates and judges stops of cars alone; several threads may share it.

    Args:
        keys: dotted, of the values that vary: only these can contradict each other.
        run_block: simulates stops where a controller is from outside.
        simulate: simulates them where none is.
        survey_biases: of measures by the survey step, as shares: stops are simulated in survey steps, and
            repeated in their own where a bias may have decided the result [default: in their own at once].
        detail: how much verdicts say, see :func:`uictest.judging.evaluation.judge`.
        nominal: the case whose noise all stops meet and as which they are judged [default: each as itself].
        noise_of: the case whose noise all stops meet, each judged as itself [default: that of `nominal`].

    """

    keys: Sequence[str]
    run_block: RunBlock
    simulate: Simulate = rig.run_in_lanes
    survey_biases: Mapping[str, float] | None = None
    detail: Detail = "status"
    nominal: Case | None = None
    noise_of: Case | None = None

    def results(self, planned: Sequence[PlannedCase]) -> tuple[list[CaseResult], list[int]]:
        """Return the results of cases, and the indices of those that a survey repeated in regular steps.

        An error in a case is its result.
        """
        if self.survey_biases is None:
            return self._results(planned), []
        surveyed = [each._replace(case=in_survey_step(each.case)) for each in planned]
        results = self._results(surveyed)
        repeated = [k for k, result in enumerate(results) if may_be_biased(result, self.survey_biases)]
        for k, result in zip(repeated, self._results([planned[k] for k in repeated]), strict=True):
            results[k] = result
        return results, repeated

    def _results(self, planned: Sequence[PlannedCase]) -> list[CaseResult]:
        assembled = [self._assembled_case(each) for each in planned]
        stops = self._simulated_stops([inputs for _, inputs, _ in assembled if inputs is not None])
        simulated = iter(stops)
        cases = [case for case, _, _ in assembled]
        results = [
            self._judged_result(case, _Simulated(problem=problem) if inputs is None else next(simulated))
            for case, inputs, problem in assembled
        ]
        asking = [
            k
            for k, (case, result) in enumerate(zip(cases, results, strict=True))
            if case.scenario.test_validity == "rail" and asks_for_rail(case, result)
        ]
        bypassed = [_with_wsp_bypassed(inputs) for k in asking if (inputs := assembled[k][1]) is not None]
        for k, stop in zip(asking, self._simulated_stops(bypassed), strict=True):
            if not stop.problem:
                results[k] = with_rail(results[k], cases[k], stop.measures, stop.wheelset_measures)
        return results

    def _assembled_case(self, planned: PlannedCase) -> tuple[Case, rig.StopInputs | None, str]:
        """Return a case as it is judged, and the inputs of the rig, or None and the reason for it."""
        case, problem = planned
        inputs = None
        if not problem:
            try:
                if first := next(inconsistencies(case.scenario, self.keys), None):
                    problem = f"{dotted(first.key)}: {first.message}"
                else:
                    case = bench.identified(case)
                    inputs = rig.assemble(case)
            except KeyError as error:
                problem = no_such_key(error)
            except UnsuitableRecordError as error:
                problem = f"rig.compensation_model: {error}"
            except (ValueError, ArithmeticError) as error:
                problem = f"{type(error).__name__}: {error}"
        if inputs is not None and self._noise_key is not None:
            inputs.parameters["noise_key"] = self._noise_key
            if inputs.config is not None:  # it is not the stop that its records name
                inputs = inputs._replace(config=replace(inputs.config, case_sha256=""))
        return case if self.nominal is None else replace(self.nominal, id=case.id), inputs, problem

    @cached_property
    def _noise_key(self) -> int | None:
        """The noise key of all stops; None where each has its own."""
        case = self.noise_of or self.nominal
        return None if case is None else int(rig.assemble(bench.identified(case)).parameters["noise_key"])

    def _simulated_stops(self, stops: Sequence[rig.StopInputs]) -> list[_Simulated]:
        """Return the measures of stops; where the simulation of all fails, they are simulated one by one."""
        if not stops:
            return []
        parameters, wheelsets, rail = rig.stacked(stops)
        try:
            if any(stop.program for stop in stops):
                run = self.run_block(rig.BlockInputs.of(stops))
                run.measures["reference_distance"] = rig.reference_distances(parameters, wheelsets, rail)
                measures, of_wheelsets, failures = run
            else:
                measures, of_wheelsets = self.simulate(parameters, wheelsets, rail)
                failures = [""] * len(stops)
        except Exception as error:
            if len(stops) == 1:
                return [_Simulated(problem=f"{type(error).__name__}: {error}")]
            return [simulated for stop in stops for simulated in self._simulated_stops([stop])]
        return [
            _Simulated(_Measures(*stop), [_WheelsetMeasures(*each) for each in own], failure)
            for stop, own, failure in zip(measures.tolist(), of_wheelsets.tolist(), failures, strict=True)
        ]

    def _judged_result(self, case: Case, stop: _Simulated) -> CaseResult:
        if stop.problem:
            return error_result(case, stop.problem)
        try:
            return evaluate_simulated(case, stop.measures, stop.wheelset_measures, detail=self.detail)
        except Exception as error:  # a case that cannot be judged is a row and does not end the sweep
            return error_result(case, f"{type(error).__name__}: {error}")


def _with_wsp_bypassed(inputs: rig.StopInputs) -> rig.StopInputs:
    parameters = inputs.parameters.copy()
    parameters["wsp_active"] = 0
    return inputs._replace(parameters=parameters)


_TOGETHER: Final = 128
"""Stops that a thread simulates in one queue, where they are many; chosen."""


@dataclass(frozen=True)
class VariedCase:
    """Runs a case with other values at some keys; all of its stops meet the noise of the case itself.

    Args:
        case: to run.
        keys: dotted, of the numbers that vary; the seed always may.
        jobs: number of threads.
        run_block: simulates blocks with controllers from outside.
        survey: whether stops are simulated in survey steps, except where a verdict might hang on it.

    """

    case: Case
    keys: Sequence[str]
    jobs: int = 1
    run_block: RunBlock = rig.run_block
    survey: bool = False

    def results(
        self, settings: Mapping[str, Column], advance: Callable[[int], None] = lambda count: None
    ) -> list[CaseResult]:
        """Return the results of stops; one whose values do not fit together, or that fails, is an error.

        Args:
            settings: the values of every key and of `seed` in each stop.
            advance: called in this thread with how many more stops are finished.

        """
        biases = biases_by_measure() if self.survey else None
        stops = ManyStops(
            (*self.keys, "seed"), self.run_block, survey_biases=biases, detail="readings", nominal=self.case
        )

        def run(indices: NDArray[np.int64]) -> list[CaseResult]:
            return stops.results([self._varied_case(settings, k) for k in indices.tolist()])[0]

        count = len(next(iter(settings.values())))
        # As many for each thread: at the end of the longest all others wait.
        rounds = -(-count // (_TOGETHER * self.jobs))
        results: list[CaseResult] = []
        with ThreadedMap(
            run, np.array_split(np.arange(count), min(rounds * self.jobs, count)), jobs=self.jobs
        ) as done:
            for together in done:
                results += together
                advance(len(together))
        return results

    def _varied_case(self, settings: Mapping[str, Column], k: int) -> PlannedCase:
        try:
            contents = {key: column[k].content for key, column in settings.items()}
            return PlannedCase(
                replace(self.case, id=str(k), scenario=with_values(self.case.scenario, contents))
            )
        except KeyError as error:
            return PlannedCase(replace(self.case, id=str(k)), no_such_key(error))


@dataclass(frozen=True)
class VariedTrain:
    """Runs a train with other values in its cars; all of its stops meet the noise of the train itself.

    A stop that was run already is not run again: what is asked of one car is often asked of the next.

    Args:
        case: any of its cars.
        jobs: number of threads.
        run_train: simulates a train with controllers from outside.
        keeps: whether it keeps what stops come to; of a series they would fill the memory.

    """

    survey: ClassVar = False
    case: Case
    jobs: int = 1
    run_train: rig.RunTrain | None = None
    keeps: bool = True
    _known: dict[tuple[str, ...], list[CaseResult]] = field(default_factory=dict)

    def results(
        self, settings: Sequence[Mapping[str, Column]], advance: Callable[[int], None] = lambda count: None
    ) -> list[list[CaseResult]]:
        """Return the results of all cars in each stop; an error in one is that of all cars.

        Args:
            settings: for each car the values at keys of its scenario, and of `seed`, in each stop.
            advance: called in this thread with how many more stops are finished.

        """
        rows = list(zip(*(column.texts for own in settings for column in own.values()), strict=True))
        new = {row: place for place, row in enumerate(rows) if row not in self._known}
        advance(len(rows) - len(new))
        size = max(_TOGETHER // len(settings), 1)
        places = list(new.values())
        blocks = [places[first : first + size] for first in range(0, len(places), size)]
        with ThreadedMap(lambda block: self._run(settings, block), blocks, jobs=self.jobs) as done:
            for block, of_block in zip(blocks, done, strict=True):
                self._known.update(zip((rows[place] for place in block), of_block, strict=True))
                advance(len(block))
        results = [self._known[row] for row in rows]
        if not self.keeps:
            self._known.clear()
        return results

    def _run(self, settings: Sequence[Mapping[str, Column]], places: Sequence[int]) -> list[list[CaseResult]]:
        trains = [self._scenarios_of_cars(settings, place) for place in places]
        problems = [train_problem(each, settings) for each in trains]
        sound = [
            self._cars_as_cases(each) for each, problem in zip(trains, problems, strict=True) if not problem
        ]
        try:
            stops = iter(rig.simulate_trains(sound, self.case, self.run_train))
        except Exception as error:  # which train it is shows when they run one by one
            if len(places) > 1:
                return [each for place in places for each in self._run(settings, [place])]
            told = "controller" if isinstance(error, ControllerError) else type(error).__name__
            problems = [f"{told}: {error}"]
        assert self.case.train is not None
        # Judged as the train itself: numbers of parts are read for the words of a reason alone.
        cars = self._cars_as_cases(self.case.train.scenarios)
        return [
            [error_result(car, problem) for car in cars]
            if problem
            else [
                evaluate_simulated(car, stop.measures, stop.wheelset_measures, detail="readings")
                for car, stop in zip(cars, next(stops), strict=True)
            ]
            for problem in problems
        ]

    def _scenarios_of_cars(
        self, settings: Sequence[Mapping[str, Column]], place: int
    ) -> tuple[Scenario, ...]:
        assert self.case.train is not None
        changed: dict[int, Scenario] = {}  # equal cars share theirs
        for car, own in zip(self.case.train.scenarios, settings, strict=True):
            if id(car) not in changed:
                changed[id(car)] = with_values(
                    car, {key: column[place].content for key, column in own.items()}
                )
        return tuple(changed[id(car)] for car in self.case.train.scenarios)

    def _cars_as_cases(self, scenarios: tuple[Scenario, ...]) -> list[Case]:
        assert self.case.train is not None
        return [
            replace(
                self.case, scenario=each, train=replace(self.case.train, number=number, scenarios=scenarios)
            )
            for number, each in enumerate(scenarios, start=1)
        ]
