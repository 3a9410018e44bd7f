"""How firm the verdicts of cases and series are: their stops, run with other values of ranged numbers."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np

from uictest import controllers, rig
from uictest.analysis.firmness import Drawn, Effort, FirmnessStudy, HoldDraws, drawn
from uictest.judging import series as judging_series
from uictest.judging.evaluation import CaseResult, Firmness, RepeatedStop, Repeats
from uictest.plans import scenario, series as series_plans, sweeps
from uictest.plans.sweeps import Column, RangedNumber
from uictest.running import campaign, chunked
from uictest.runs.observer import Advance
from uictest.runs.scenario_files import InvalidInputError

_TOGETHER: Final = 128
"""Draws of a series whose stops are in memory at a time; chosen."""
EFFORT: Final = Effort()
"""How many stops the commands run of each case."""
_Identity = tuple[str, str, str, str]
"""Key, value and range of a number: cases of a series that state the same ones share its draws."""
_Columns = Mapping[_Identity, Column]


@dataclass(frozen=True)
class FirmnessRun:
    """Finds out how firm verdicts are.

    Args:
        jobs: number of threads.
        advance: is called with how many more stops are finished, and how many more a search takes.
        run_block: simulates stops with controllers from outside.
        run_train: simulates trains with such controllers.
        effort: how many stops.
        calibration: stops by which the numbers are known, with the outcomes that these expect.
    """

    jobs: int
    advance: Advance = lambda finished, further=0: None
    run_block: chunked.RunBlock = rig.run_block
    run_train: rig.RunTrain = rig.run_train_in_process
    effort: Effort = EFFORT
    calibration: Sequence[scenario.Case] = ()
    trains: dict[str, chunked.VariedTrain] = field(default_factory=dict)
    """The train that cases were cars of last, by its id."""
    keeps: bool = True  # the stops of that; those of a series would fill the memory

    def of_case(self, case: scenario.Case) -> Firmness:
        """Return the firmness of the verdicts of a case; of a repeated one, those of its stops one by one."""
        stops = _VariedStops.of(campaign.Stop(case).alone, self, survey=True)

        def judge(columns: Sequence[Column], seeds: Sequence[int]) -> list[Drawn]:
            results = stops.results(dict(zip(stops.numbers, columns, strict=True)), seeds)
            return [drawn(result.outcome, result.decided) for [result] in results]

        return self._study_stops([stops], stops.numbers, judge, case.scenario.judged_by)

    def of_series(self, planned: series_plans.Series) -> Firmness:
        """Return the firmness of the verdicts of a series; a number that several of its cases have is one."""
        cases = [_VariedStops.of(case, replace(self, keeps=False, trains={})) for case in planned.cases]
        numbers = {identity: number for case in cases for identity, number in case.numbers.items()}

        def judge(columns: Sequence[Column], seeds: Sequence[int]) -> list[Drawn]:
            verdicts: list[Drawn] = []
            for first in range(0, len(seeds), _TOGETHER):
                rows = np.arange(first, min(first + _TOGETHER, len(seeds)))
                taken = {key: column.take(rows) for key, column in zip(numbers, columns, strict=True)}
                of_cases = [case.results(taken, seeds[first : first + rows.size]) for case in cases]
                verdicts += [_judged_series(planned, stops) for stops in zip(*of_cases, strict=True)]
            return verdicts

        return self._study_stops(cases, numbers, judge, planned.file.criteria)

    def _study_stops(
        self,
        cases: Sequence[_VariedStops],
        numbers: Mapping[_Identity, RangedNumber],
        judge: Callable[[Sequence[Column], Sequence[int]], list[Drawn]],
        profiles: Sequence[scenario.Criteria],
    ) -> Firmness:
        validity = frozenset(
            criterion.id
            for profile in profiles
            for criterion in profile.criteria
            if criterion.layer == "validity"
        )
        hold = self._calibration_check(numbers) if self.calibration else None
        random_rail = any(stops.case.scenario.rail.variation_in_force for stops in cases)
        repeats = sum(stops.case.scenario.repeat for stops in cases)
        study = FirmnessStudy(
            *(list(numbers.values()), judge, hold, validity, self.effort, random_rail),
            expect=lambda stops: self.advance(0, stops * repeats),
        )
        return study.run(
            on_four_calipers=any(stops.on_four_calipers for stops in cases),
            in_survey_steps=any(stops.varied.survey for stops in cases),
            calibrated_by=[case.id for case in self.calibration],
            without_range=[
                key for stops in cases for key in sweeps.numbers_without_range(stops.case.scenario)
            ],
        )

    def _calibration_check(self, numbers: Mapping[_Identity, RangedNumber]) -> HoldDraws:
        """Return the check whether all calibrating stops come to what they expect under draws.

        Raises InvalidInputError for a stop that has none of the numbers.
        """
        calibrating = [_VariedStops.of(case, self) for case in self.calibration]
        for case, stops in zip(self.calibration, calibrating, strict=True):
            if numbers.keys().isdisjoint(stops.numbers):
                raise InvalidInputError(
                    f"--calibrated-by: {case.id} has none of the numbers that vary, with the same value and"
                    " range: it says nothing of them"
                )

        def hold(columns: Sequence[Column]) -> list[bool]:
            taken = dict(zip(numbers, columns, strict=True))
            outcomes = [stops.as_expected(taken, len(columns[0])) for stops in calibrating]
            return [all(of_draw) for of_draw in zip(*outcomes, strict=True)]

        return hold

    def require_calibration(self) -> None:
        """Raise InvalidInputError where a calibrating stop comes to another outcome itself."""
        self.advance(0, sum(case.scenario.repeat for case in self.calibration))
        for case in self.calibration:
            if not all(_VariedStops.of(case, self).as_expected({}, 1)):
                raise InvalidInputError(
                    f"--calibrated-by: {case.id} is not {case.scenario.expect} at the nominal values: it says"
                    " nothing of others"
                )


@dataclass(frozen=True)
class _VariedStops:
    """The stops of a case, with other values of its ranged numbers.

    Numbers of the caliper, its tank or the valves are among these as a rule, and a compensation stands in
    only for the rig that it was identified for. So all stops are run with a caliper in every module.
    """

    varied: chunked.VariedCase | chunked.VariedTrain
    case: scenario.Case
    of_cars: Sequence[Mapping[_Identity, RangedNumber]]
    numbers: Mapping[_Identity, RangedNumber]
    run: FirmnessRun
    on_four_calipers: bool

    @classmethod
    def of(cls, case: scenario.Case, run: FirmnessRun, *, survey: bool = False) -> _VariedStops:
        """Take a case; with `survey` its stops are of survey steps where these are known to do for it."""
        of_cars = [_numbers_of(car) for car in case.cars]
        numbers = {identity: number for of_car in of_cars for identity, number in of_car.items()}
        moved = any(car.scenario.rig.topology != "four-caliper" for car in case.cars)
        varied = (
            _varied_train(case, run) if case.train is not None else _varied_car(case, numbers, run, survey)
        )
        return cls(varied, case, of_cars, numbers, run, moved)

    def results(self, columns: _Columns, seeds: Sequence[int]) -> list[list[CaseResult]]:
        """Return for each row of the columns the results of the stops, one for each repeat of the case.

        A number without a column is nominal.
        A seed counts from that of the case, in steps of its repeats, and goes on from 0 after the largest.
        """
        resolved = self.case.scenario
        repeat = resolved.repeat
        rows = np.repeat(np.arange(len(seeds)), repeat)
        known = scenario.LARGEST_SEED + 2 - repeat  # how many seeds a case with these repeats may have
        numbers = [(resolved.seed + seed * repeat + k) % known for seed in seeds for k in range(repeat)]
        nominal = np.full(len(seeds), np.nan)
        drawn = {
            key: (columns[key] if key in columns else number.at(nominal)).take(rows)
            for key, number in self.numbers.items()
        }
        seed = {"seed": sweeps.listed_column([sweeps.ParameterValue(str(k), k) for k in numbers])}
        settings = [
            {number.key: drawn[key] for key, number in of_car.items()} | seed for of_car in self.of_cars
        ]
        if isinstance(self.varied, chunked.VariedTrain):
            assert self.case.train is not None
            car = self.case.train.number - 1
            results = [of_cars[car] for of_cars in self.varied.results(settings, self.run.advance)]
        else:
            results = self.varied.results(settings[0], self.run.advance)
        return [results[first : first + repeat] for first in range(0, len(results), repeat)]

    def as_expected(self, columns: _Columns, count: int) -> list[bool]:
        """Return for each row of the columns whether all stops come to what the case expects."""
        return [all(stop.as_expected for stop in stops) for stops in self.results(columns, [0] * count)]


def _numbers_of(case: scenario.Case) -> dict[_Identity, RangedNumber]:
    numbers: dict[_Identity, RangedNumber] = {}
    for number in sweeps.ranged_numbers(case.scenario):
        low, high = number.ends
        numbers[number.key, number.value.text, low.text, high.text] = number
    return numbers


def _varied_car(
    case: scenario.Case, numbers: Mapping[_Identity, RangedNumber], run: FirmnessRun, survey: bool
) -> chunked.VariedCase:
    changed = replace(case, scenario=_on_four_calipers(case.scenario))
    keys = [number.key for number in numbers.values()]
    in_survey = survey and case.scenario.simulation.time_step == sweeps.REGULAR_STEP
    return chunked.VariedCase(changed, keys, run.jobs, run.run_block, in_survey)


def _varied_train(case: scenario.Case, run: FirmnessRun) -> chunked.VariedTrain:
    """Return the train of a car: that of the case before, where it was a car of the same."""
    assert case.train is not None
    four = {id(stated): _on_four_calipers(stated) for stated in case.train.scenarios}
    cars = tuple(four[id(stated)] for stated in case.train.scenarios)
    place = replace(case.train, scenarios=cars)
    known = run.trains.get(place.train)
    if known is None or known.case.train is None or known.case.train.scenarios != cars:
        run.trains.clear()
        changed = replace(case, scenario=cars[place.number - 1], train=place)
        run.trains[place.train] = chunked.VariedTrain(changed, run.jobs, run.run_train, run.keeps)
    return run.trains[place.train]


def _on_four_calipers(stated: scenario.Scenario) -> scenario.Scenario:
    four = stated.rig.model_copy(update={"topology": "four-caliper"})
    return stated.model_copy(update={"rig": four})


def _judged_series(planned: series_plans.Series, stops: Sequence[Sequence[CaseResult]]) -> Drawn:
    """Return the verdicts of a series on the stops of its cases."""
    results = [_repeated_case(case, of_case) for case, of_case in zip(planned.cases, stops, strict=True)]
    result = judging_series.judge_results(planned, results)
    return drawn(result.outcome, [criterion.verdict for criterion in result.criteria])


def _repeated_case(case: scenario.Case, stops: Sequence[CaseResult]) -> CaseResult:
    """Return a case that holds some stops, for a series, which looks at these alone."""
    repeats = tuple(
        RepeatedStop(k, stop.outcome, stop.reason, stop.criteria, stop.measures, stop.wheelsets)
        for k, stop in enumerate(stops)
    )
    return replace(stops[0], id=case.id, repeats=Repeats("all", repeats))


def stops_of_case(case: scenario.Case, settings: campaign.RunSettings) -> int:
    """Return the number of stops that are run for a case before turning values are searched."""
    numbers = {identity for car in case.cars for identity in _numbers_of(car)}
    return EFFORT.stops(len(numbers)) + _calibrating_stops(settings)


def stops_of_series(planned: series_plans.Series, settings: campaign.RunSettings) -> int:
    """Return the number of stops that are run for a series before turning values are searched."""
    numbers = {identity for case in planned.cases for car in case.cars for identity in _numbers_of(car)}
    stops = EFFORT.stops(len(numbers)) * sum(case.scenario.repeat for case in planned.cases)
    return stops + _calibrating_stops(settings)


def _calibrating_stops(settings: campaign.RunSettings) -> int:
    return EFFORT.draws * sum(case.scenario.repeat for case in settings.calibration)


@contextmanager
def firmness_run(settings: campaign.RunSettings, advance: Advance) -> Iterator[FirmnessRun]:
    """Lend what finds out how firm verdicts are; `advance` hears of its stops."""
    with rig.Workers() as workers:
        here, isolated = (rig.run_block, rig.run_train_in_process), (workers.run_block, workers.run_train)
        run_with = here if settings.in_process else isolated
        try:
            run = FirmnessRun(settings.jobs, advance, *run_with, EFFORT, settings.calibration)
            run.require_calibration()
            yield run
        except KeyboardInterrupt:
            controllers.interrupt_turns()
            raise
