"""One case, run with other values of some of its numbers and under other seeds."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import ClassVar, Final

import numpy as np

from uictest import rig
from uictest.controllers import ControllerError
from uictest.judging.evaluation import CaseResult, error_result, evaluate_simulated
from uictest.plans.scenario import Case, Scenario
from uictest.plans.sweeps import (
    Column,
    ListedGroup,
    ParameterValue,
    Plan,
    train_problem,
    value_at,
    with_values,
)
from uictest.running.campaign import ThreadedMap
from uictest.running.chunked.chunk import BlockRunner, RunBlock, block_runner

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
        count = len(next(iter(settings.values())))
        names = np.arange(count)
        runner = self._runner

        def run(places: np.ndarray[tuple[int], np.dtype[np.int64]]) -> list[CaseResult]:
            values = {key: column.take(places) for key, column in settings.items()}
            block = runner.assembler.of_settings(places, [str(place) for place in places.tolist()], values)
            return runner.results(block)[0]

        # As many for each thread: at the end of the longest all others wait.
        rounds = -(-count // (_TOGETHER * self.jobs))
        blocks = np.array_split(names, min(rounds * self.jobs, count))
        results: list[CaseResult] = []
        with ThreadedMap(run, blocks, jobs=self.jobs) as done:
            for of_block in done:
                results += of_block
                advance(len(of_block))
        return results

    @cached_property
    def _runner(self) -> BlockRunner:
        keys = (*self.keys, "seed")
        nominal = tuple(ParameterValue("", value_at(self.case.scenario, key)) for key in keys)
        plan = Plan(
            *(self.case.id, "", "", self.case, (ListedGroup(keys, (nominal,)),), {}), survey=self.survey
        )
        return block_runner(plan, self.run_block, as_base=True, detail="readings")


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
        trains = [self._scenarios(settings, place) for place in places]
        problems = [train_problem(each, settings) for each in trains]
        sound = [self._cars(each) for each, problem in zip(trains, problems, strict=True) if not problem]
        try:
            stops = iter(rig.simulate_trains(sound, self.case, self.run_train))
        except Exception as error:  # which train it is shows when they run one by one
            if len(places) > 1:
                return [each for place in places for each in self._run(settings, [place])]
            told = "controller" if isinstance(error, ControllerError) else type(error).__name__
            problems = [f"{told}: {error}"]
        assert self.case.train is not None
        # Judged as the train itself: numbers of parts are read for the words of a reason alone.
        cars = self._cars(self.case.train.scenarios)
        return [
            [error_result(car, problem) for car in cars]
            if problem
            else [
                evaluate_simulated(car, stop.measures, stop.wheelset_measures, detail="readings")
                for car, stop in zip(cars, next(stops), strict=True)
            ]
            for problem in problems
        ]

    def _scenarios(self, settings: Sequence[Mapping[str, Column]], place: int) -> tuple[Scenario, ...]:
        assert self.case.train is not None
        changed: dict[int, Scenario] = {}  # equal cars share theirs
        for car, own in zip(self.case.train.scenarios, settings, strict=True):
            if id(car) not in changed:
                changed[id(car)] = with_values(
                    car, {key: column[place].content for key, column in own.items()}
                )
        return tuple(changed[id(car)] for car in self.case.train.scenarios)

    def _cars(self, scenarios: tuple[Scenario, ...]) -> list[Case]:
        assert self.case.train is not None
        return [
            replace(
                self.case,
                scenario=each,
                train=replace(self.case.train, number=number, scenarios=scenarios),
            )
            for number, each in enumerate(scenarios, start=1)
        ]
