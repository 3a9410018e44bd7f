"""Run and judge the stops of studies; each stop is run once."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, TypeVar

import uictest
from uictest import Case, CaseResult, Recording

_SCENARIOS = Path(__file__).parent / "scenarios"

Argument = TypeVar("Argument")
Result = TypeVar("Result")


@dataclass(frozen=True, slots=True)
class Stops:
    """The judged stops of one case, one per seed."""

    case: Case
    stops: Sequence[CaseResult]


class StopRunner:
    """Runs the stops of studies, and keeps their results.

    Args:
        jobs: threads to simulate on.
    """

    def __init__(self, jobs: int = 1) -> None:
        self._jobs = jobs
        self._results: dict[str, CaseResult] = {}
        self.inputs: dict[str, str] = {}
        """Every file that the cases of the study were loaded from -> its SHA-256."""

    def cases(self, scenario: str, changes: Mapping[str, Any] | None = None) -> tuple[Case, ...]:
        """Return the cases of a scenario of the studies, changed as by `set` of :func:`uictest.load`."""
        cases = uictest.load(_SCENARIOS / f"{scenario}.yaml", set=changes)
        for case in cases:
            self.inputs.update(case.inputs)
        return cases

    def repeated(self, cases: Sequence[Case], seeds: Sequence[int]) -> list[Stops]:
        """Return the stops, without recording, of every case under every seed of the sensors' noise."""
        repeats = [[seeded(case, seed) for seed in seeds] for case in cases]
        keyed = {_key(each): each for of_case in repeats for each in of_case}
        missing = {key: each for key, each in keyed.items() if key not in self._results}
        for batch in _batches(missing):
            self._results.update(zip(batch, _judged(list(batch.values()), self._jobs), strict=True))
        return [
            Stops(case, [self._results[_key(each)] for each in of_case])
            for case, of_case in zip(cases, repeats, strict=True)
        ]

    def recordings(self, cases: Sequence[Case]) -> list[Recording]:
        """Return a recording of the stop of every case, a sample in each cycle of the controller."""
        return self.map(uictest.simulate, cases)

    def map(self, work: Callable[[Argument], Result], arguments: Sequence[Argument]) -> list[Result]:
        """Return the result of `work` for each argument, in order; the compiled rig releases the GIL."""
        with ThreadPoolExecutor(self._jobs) as threads:
            return list(threads.map(work, arguments))


def seeded(case: Case, seed: int) -> Case:
    """Return a case with another seed of the sensors' noise."""
    return replace(case, scenario=case.scenario.model_copy(update={"seed": seed}))


def constant_friction(case: Case) -> float:
    """Return the initial friction coefficient of a case whose rail has the same one everywhere."""
    friction = case.scenario.rail.friction
    assert isinstance(friction, float)
    return friction


def _key(case: Case) -> str:
    """Return what identifies a stop: its id, which seeds the noise, and all of its scenario."""
    return f"{case.id} {case.scenario.model_dump_json()}"


def _batches(cases: Mapping[str, Case]) -> Iterator[dict[str, Case]]:
    """Divide cases among batches in which every id stands once, as `uictest.run` asks for."""
    left = dict(cases)
    while left:
        by_id = {case.id: key for key, case in reversed(left.items())}
        batch = {key: case for key, case in left.items() if by_id[case.id] == key}
        yield batch
        left = {key: case for key, case in left.items() if key not in batch}


def _judged(cases: Sequence[Case], jobs: int) -> list[CaseResult]:
    results = list(uictest.run(cases, record="none", jobs=jobs))
    for result in results:
        if result.outcome == "error":
            raise RuntimeError(f"{result.id}: {result.reason}")
    return results


def measured(stop: CaseResult, name: str) -> float:
    """Return a measure of a stop by its name in results, such as `braking_distance_m`; NaN: not reached."""
    assert stop.measures is not None  # only a stop that failed has none
    return stop.measures[name]


def verdict_value(stop: CaseResult, criterion: str) -> float:
    """Return the value that a criterion found, in its own unit; NaN where it does not apply."""
    value = next(verdict.value for verdict in stop.criteria if verdict.id == criterion)
    return float("nan") if value is None else value
