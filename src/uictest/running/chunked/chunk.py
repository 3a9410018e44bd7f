"""The cases of a sweep in chunks: which are selected, and how a chunk is run to the bytes of its file."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain, groupby
from pathlib import PurePath
from typing import Final

import numpy as np
from numpy.typing import NDArray

from uictest import rig
from uictest.judging.evaluation import CaseResult, error_result
from uictest.plans.scenario import Case
from uictest.plans.sweeps import Column, Plan, train_problem
from uictest.running.campaign import (
    RecordingRequest,
    ThreadedMap,
    mentioned_in,
    parse,
    run_trains,
    stops_together,
)
from uictest.running.chunked.many_stops import ManyStops, PlannedCase, RunBlock, no_such_key
from uictest.running.chunked.table import biases_by_measure, parquet_bytes, rows

_SMALLEST_CHUNK: Final = 16
_CHUNKING: Final = ((1024, 32), (4096, 64))
"""Most cases in a chunk and the number of chunks to aim at.

What a chunk costs whatever its size counts in a sweep that takes hours, whose chunks may take ten seconds.
"""
_IDS_AT_ONCE: Final = 4096
"""Ids that are made, and in memory, at a time; chosen."""


@dataclass(frozen=True)
class CaseSelection:
    """The selected cases of a plan in order; `selected` holds their indices, None where all are selected."""

    plan: Plan
    selected: NDArray[np.int64] | None = None

    @property
    def size(self) -> int:
        """Number of cases."""
        return self.plan.size if self.selected is None else int(self.selected.size)

    @property
    def chunk_size(self) -> int:
        """Cases in a chunk: seconds of work, and the same on every machine."""
        sizes = (min(largest, self.size // chunks) for largest, chunks in _CHUNKING)
        return max(_SMALLEST_CHUNK, *sizes)

    @property
    def chunks(self) -> int:
        """Number of chunks."""
        return -(-self.size // self.chunk_size)

    def chunk(self, number: int) -> NDArray[np.int64]:
        """Return the indices of the cases in a chunk."""
        first = number * self.chunk_size
        return self.indices(first, min(first + self.chunk_size, self.size))

    def id_blocks(self) -> Iterator[list[str]]:
        """Yield the ids of the cases in order, some thousands at a time."""
        for first in range(0, self.size, _IDS_AT_ONCE):
            yield self.plan.ids(self.indices(first, min(first + _IDS_AT_ONCE, self.size)))

    def indices(self, first: int, end: int) -> NDArray[np.int64]:
        """Return the indices of the cases from place `first` to before place `end`."""
        return np.arange(first, end) if self.selected is None else self.selected[first:end]


def select_cases(plan: Plan, expression: str | None) -> CaseSelection:
    """Return the cases whose id, sweep file or tags match an expression. Raises ExpressionError."""
    if expression is None:
        return CaseSelection(plan)
    matches = parse(expression)
    common_names = (PurePath(plan.file).name, *plan.base.scenario.tags)
    selected: list[NDArray[np.int64]] = []
    for first in range(0, plan.size, _IDS_AT_ONCE):
        indices = np.arange(first, min(first + _IDS_AT_ONCE, plan.size))
        is_selected = [matches(mentioned_in((name, *common_names))) for name in plan.ids(indices)]
        selected.append(indices[np.array(is_selected)])
    return CaseSelection(plan, np.concatenate(selected))


_FORM = re.compile(r"([0-9]{1,6})/([0-9]{1,6})")


@dataclass(frozen=True, slots=True)
class Shard:
    """Shard `number` (from 1) of `count`."""

    number: int = 1
    count: int = 1

    def chunk_numbers(self, chunks: int) -> Sequence[int]:
        """Return the numbers of this shard's chunks: every `count`-th, so that shards take alike long."""
        return range(self.number - 1, chunks, self.count)


def parse_shard(text: str) -> Shard:
    """Read a shard written as `i/n`, 1 <= i <= n. Raises ValueError."""
    match = _FORM.fullmatch(text)
    if match is None or not 1 <= int(match[1]) <= int(match[2]):
        raise ValueError(f"{text!r} is not a shard: write 2/8 for the second of eight")
    return Shard(int(match[1]), int(match[2]))


WriteChunk = Callable[[int, bytes], None]
"""Takes the number of a finished chunk and its results."""
_QUEUED = 256
"""Cases that are simulated in one queue, where they are many: at its end lanes idle; chosen."""
_LEAST_QUEUED = 64
"""Cases in one queue, where there are so many for each thread; chosen."""
_QUEUES_AHEAD = 2
"""Queues that wait or are ready beyond those in progress: bounds memory."""


@dataclass(frozen=True)
class ChunkRunner:
    """Simulates and judges the cases of chunks; several threads may share it.

    Args:
        plan: of the sweep.
        stops: simulates cars alone.
        run_train: simulates a train with controllers from outside.

    """

    plan: Plan
    stops: ManyStops
    run_train: rig.RunTrain | None = None

    def run(self, indices: NDArray[np.int64]) -> bytes:
        """Return the rows of the cases with the given indices as a Parquet file."""
        [content] = self.run_together([indices])
        return content

    def run_together(self, chunks: Sequence[NDArray[np.int64]]) -> list[bytes]:
        """Return the Parquet files of several chunks, whose cases are simulated in one queue."""
        indices = np.concatenate(chunks)
        settings = self.plan.settings(indices)
        results, repeated = self.results(indices, settings)
        table = rows(self.plan, indices, settings, results, repeated)
        sizes = [chunk.size for chunk in chunks]
        begins = np.cumsum([0, *sizes[:-1]]).tolist()
        return [parquet_bytes(table.slice(*span)) for span in zip(begins, sizes, strict=True)]

    def of_plan(self, plan: Plan) -> ChunkRunner:
        """Return a runner of another plan of the same sweep."""
        return replace(self, plan=plan, stops=replace(self.stops, keys=plan.keys))

    def results(
        self, indices: NDArray[np.int64], settings: Mapping[str, Column]
    ) -> tuple[list[CaseResult], list[int]]:
        """Return the results of cases, and the positions of those that a survey repeated in regular steps.

        `settings` are the values of the cases by key. An error in a case is its result.
        """
        if self.plan.own_keys:
            return self._results_of_trains(indices), []
        return self.stops.results(list(self._cars_alone(indices, settings)))

    def _cars_alone(
        self, indices: NDArray[np.int64], settings: Mapping[str, Column]
    ) -> Iterator[PlannedCase]:
        base = self.plan.base
        for k, name in enumerate(self.plan.ids(indices)):
            contents = {key: column[k].content for key, column in settings.items()}
            try:
                [scenario] = self.plan.scenarios(contents)
                yield PlannedCase(Case(name, scenario, base.path, {}, {}))
            except KeyError as error:
                yield PlannedCase(replace(base, id=name), no_such_key(error))

    def _results_of_trains(self, indices: NDArray[np.int64]) -> list[CaseResult]:
        """Return the results of cars; an error in one is its result. Each train is run once for all of its
        cars among the cases.
        """
        cars = list(self._cars_of_trains(indices))
        sound = (car.case for car in cars if not car.problem)
        runs = iter(run_trains(list(stops_together(sound)), RecordingRequest("none"), self.run_train))
        return [error_result(*car) if car.problem else next(runs).case_run.result for car in cars]

    def _cars_of_trains(self, indices: NDArray[np.int64]) -> Iterator[PlannedCase]:
        for _, of_train in groupby(indices.tolist(), lambda index: index // len(self.plan.own_keys)):
            in_train = np.array([*of_train])
            try:
                cars = self.plan.cases(in_train)
                assert cars[0].train is not None
                keys = (own.values() for own in self.plan.own_keys)
                problem = train_problem(cars[0].train.scenarios, keys)
            except KeyError as error:
                cars = [replace(self.plan.base, id=name) for name in self.plan.ids(in_train)]
                problem = no_such_key(error)
            yield from (PlannedCase(car, problem) for car in cars)


def chunk_runner(plan: Plan, run_block: RunBlock, run_train: rig.RunTrain | None = None) -> ChunkRunner:
    """Return a runner for a plan; what runs blocks or trains is asked where a controller is from outside."""
    biases = biases_by_measure() if plan.survey else None
    return ChunkRunner(plan, ManyStops(plan.keys, run_block, survey_biases=biases), run_train)


def run_on_threads(
    runner: ChunkRunner,
    selection: CaseSelection,
    numbers: Sequence[int],
    jobs: int,
    write_chunk: WriteChunk,
    meanwhile: Callable[[], None] = lambda: None,
) -> None:
    """Run the chunks with the given numbers; `write_chunk` gets each in this thread, in this order.

    While the first run, `meanwhile` is called in this thread. After any exception, KeyboardInterrupt
    included, the chunks that `write_chunk` got are kept.
    """
    jobs = min(jobs, len(numbers)) or 1
    with ThreadedMap(
        lambda queue: runner.run_together([selection.chunk(number) for number in queue]),
        queues_of(numbers, jobs, selection.chunk_size),
        jobs=jobs,
        pending=jobs + _QUEUES_AHEAD,
    ) as contents:
        meanwhile()
        for number, content in zip(numbers, chain.from_iterable(contents), strict=True):
            write_chunk(number, content)


def queues_of(numbers: Sequence[int], jobs: int, chunk_size: int) -> list[Sequence[int]]:
    """Return the chunks that are simulated in one queue each.

    Where several threads take them, a queue holds half of a thread's share of what is left: few lanes idle at
    the ends of the first, and few threads wait for the end of the last.
    """
    most, least = (max(cases // chunk_size, 1) for cases in (_QUEUED, _LEAST_QUEUED))
    queues: list[Sequence[int]] = []
    left = numbers
    while left:
        half, share = -(-len(left) // (2 * jobs)), -(-len(left) // jobs)
        size = min(most, max(half, min(least, share))) if jobs > 1 else most
        queues.append(left[:size])
        left = left[size:]
    return queues
