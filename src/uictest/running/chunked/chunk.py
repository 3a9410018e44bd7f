"""Run one chunk of a sweep and encode its results as Parquet."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import namedtuple
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain, groupby
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest import rig
from uictest.core.ensemble import rows_at
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
from uictest.plans.scenario import Case
from uictest.plans.sweeps import Plan, in_survey_steps, train_problem
from uictest.running.campaign import RecordingRequest, ThreadedMap, run_trains, stops_together
from uictest.running.chunked.case_blocks import BlockAssembler, CaseBlock, CaseValues
from uictest.running.chunked.case_selection import CaseSelection
from uictest.running.chunked.table import biases_by_measure, parquet_bytes, rows

RunBlock = Callable[[rig.BlockInputs], rig.BlockRun]
"""Simulates a block in which a controller comes from outside: here, or in child processes."""
Measures = tuple[NDArray[Any], NDArray[Any]]
"""Measures of stops, shape (cases,), and of their wheelsets, (cases, 4)."""
# Judging reads many fields, and a numpy record takes ten times as long to read as a tuple.
_tuple_of: Any = namedtuple
_Stop: Final = _tuple_of("_Stop", STOP_MEASURES.names)
_Wheelset: Final = _tuple_of("_Wheelset", WHEELSET_MEASURES.names)
Records = tuple[tuple[Any, ...], list[tuple[Any, ...]]]
"""Measures of one stop and of its wheelsets."""
Simulate = Callable[[NDArray[Any], NDArray[Any], NDArray[np.float64]], Measures]
"""Simulates cases: records, those of wheelsets and friction laws to measures."""
WriteChunk = Callable[[int, bytes], None]
"""Takes the number of a finished chunk and its results."""
_QUEUED = 256
"""Cases that are simulated in one queue, where they are many: at its end lanes idle; chosen."""
_LEAST_QUEUED = 64
"""Cases in one queue, where there are so many for each thread; chosen."""
_QUEUES_AHEAD = 2
"""Queues that wait or are ready beyond those in progress: bounds memory."""


class ChunkRunner(ABC):
    """Simulates and judges the cases of one chunk; several threads may share a runner."""

    plan: Plan
    run_block: RunBlock
    run_train: rig.RunTrain | None = None

    def run(self, indices: NDArray[np.int64]) -> bytes:
        """Return the rows of the cases with the given indices as a Parquet file."""
        [content] = self.run_together([indices])
        return content

    def run_together(self, chunks: Sequence[NDArray[np.int64]]) -> list[bytes]:
        """Return the Parquet files of several chunks, whose cases are simulated in one queue."""
        table = rows(self.plan, *self.results_of(np.concatenate(chunks)))
        sizes = [indices.size for indices in chunks]
        begins = np.cumsum([0, *sizes[:-1]]).tolist()
        return [parquet_bytes(table.slice(*place)) for place in zip(begins, sizes, strict=True)]

    @abstractmethod
    def results_of(self, indices: NDArray[np.int64]) -> tuple[CaseValues, list[CaseResult], list[int]]:
        """Return cases, their results, and the places of those of a survey that are of regular steps."""


@dataclass(frozen=True)
class TrainRunner(ChunkRunner):
    """Runs the cars of trains: each train once for all of its cars in a queue."""

    plan: Plan
    run_block: RunBlock
    run_train: rig.RunTrain | None = None

    def results_of(self, indices: NDArray[np.int64]) -> tuple[CaseValues, list[CaseResult], list[int]]:
        """Return cars and their results; an error in one is its result."""
        cars = list(self._cars(indices))
        sound = (case for case, reason in cars if not reason)
        runs = iter(run_trains(list(stops_together(sound)), RecordingRequest("none"), self.run_train))
        results = [
            error_result(case, reason) if reason else next(runs).case_run.result for case, reason in cars
        ]
        return CaseValues(indices, self.plan.ids(indices), self.plan.settings(indices)), results, []

    def _cars(self, indices: NDArray[np.int64]) -> Iterator[tuple[Case, str]]:
        """Yield cars, and why their train cannot run, empty where it can."""
        base = self.plan.base
        for _, of_train in groupby(indices.tolist(), lambda index: index // len(self.plan.own_keys)):
            places = np.array([*of_train])
            try:
                cars = self.plan.cases(places)
                assert cars[0].train is not None
                keys = (own.values() for own in self.plan.own_keys)
                reason = train_problem(cars[0].train.scenarios, keys)
            except KeyError as error:  # a value of one key leaves no place for that of another
                cars = [replace(base, id=name) for name in self.plan.ids(places)]
                reason = f"{error.args[0]!r}: no such key beside the other values of this case"
            yield from ((car, reason) for car in cars)


@dataclass(frozen=True)
class BlockRunner(ChunkRunner):
    """Runs cars alone."""

    assembler: BlockAssembler
    simulate: Simulate
    plan: Plan
    run_block: RunBlock
    biases: Mapping[str, float] | None = None
    """Of measures, in a survey: those of the step that the cases are simulated in."""
    detail: Detail = "status"
    """How much verdicts say, see :func:`uictest.judging.evaluation.judge`."""
    regular: BlockRunner | None = None
    """In a survey: simulates in regular steps what lies within its bias of a limit."""

    def results_of(self, indices: NDArray[np.int64]) -> tuple[CaseValues, list[CaseResult], list[int]]:
        """Return cases and their results, see :meth:`results`."""
        block = self.assembler.block(indices)
        return block, *self.results(block)

    def results(self, block: CaseBlock) -> tuple[list[CaseResult], list[int]]:
        """Return the results of a block; an error in a case is its result.

        Those of a survey that a bias may have decided are of regular steps: the second list has their places.
        """
        results, biases = self._results_in_own_steps(block), self.biases or {}
        if self.regular is None:
            return results, []
        repeated = [place for place, result in enumerate(results) if may_be_biased(result, biases)]
        if repeated:
            again = self.regular.assembler.again(block, np.array(repeated))
            for place, result in zip(repeated, self.regular.results(again)[0], strict=True):
                results[place] = result
        return results, repeated

    def _results_in_own_steps(self, block: CaseBlock) -> list[CaseResult]:
        places = np.array([place for place, reason in enumerate(block.rejections) if not reason], np.int64)
        records: dict[int, Records] = {}
        if places.size:
            try:
                stops, wheelsets = self._simulated(block, places)
            except Exception as error:
                return self._run_one_by_one(block, error)
            of_each = zip(stops.tolist(), wheelsets.tolist(), strict=True)
            records = dict(zip(places.tolist(), of_each, strict=True))
        results = [self._result(block, place, records.get(place)) for place in range(len(block.ids))]
        return self._with_rails(block, results)

    def _with_rails(self, block: CaseBlock, results: list[CaseResult]) -> list[CaseResult]:
        """Return results in which the rail decides where scenarios say so: the same stops, WSP bypassed."""
        if self.plan.base.scenario.test_validity != "rail" and "test_validity" not in self.plan.keys:
            return results
        cases = [self.assembler.case(block, place) for place in range(len(results))]
        places = np.array(
            [
                place
                for place, (case, result) in enumerate(zip(cases, results, strict=True))
                if case.scenario.test_validity == "rail" and asks_for_rail(case, result)
            ],
            np.int64,
        )
        if places.size:
            bypassed = block.take(places)
            bypassed.parameters["wsp_active"] = 0
            stops, wheelsets = self._simulated(bypassed, np.arange(places.size))
            of_each = zip(
                places.tolist(), bypassed.rejections, stops.tolist(), wheelsets.tolist(), strict=True
            )
            for place, failure, stop, own in of_each:
                if not failure:
                    records = _Stop(*stop), [_Wheelset(*each) for each in own]
                    results[place] = with_rail(results[place], cases[place], *records)
        return results

    def _result(self, block: CaseBlock, place: int, records: Records | None) -> CaseResult:
        case, reason = self.assembler.case(block, place), block.rejections[place]
        if records is not None and not reason:
            try:
                stop, wheelsets = _Stop(*records[0]), [_Wheelset(*each) for each in records[1]]
                return evaluate_simulated(case, stop, wheelsets, detail=self.detail)
            except Exception as error:  # a case that cannot be judged is a row and does not end the sweep
                reason = f"{type(error).__name__}: {error}"
        return error_result(case, reason)

    def _simulated(self, block: CaseBlock, places: NDArray[np.int64]) -> Measures:
        """Return the measures of some cases; one whose controller from outside fails becomes a rejection."""
        inputs = (
            rows_at(block.parameters, places),
            rows_at(block.wheelset_parameters, places),
            rows_at(block.rail, places),
        )
        programs = [block.programs[place] for place in places.tolist()]
        if not any(programs):
            return self.simulate(*inputs)
        configs = [block.configs[place] for place in places]
        run = self.run_block(rig.BlockInputs(programs, configs, *inputs))
        for place, failure in zip(places, run.failures, strict=True):
            block.rejections[place] = failure
        run.measures["reference_distance"] = rig.reference_distances(*inputs)
        return run.measures, run.wheelset_measures

    def _run_one_by_one(self, block: CaseBlock, error: Exception) -> list[CaseResult]:
        """Find the case that caused the error of the block."""
        if len(block.ids) == 1:
            block.rejections[0] = f"{type(error).__name__}: {error}"
            return self._results_in_own_steps(block)
        alone = (block.take(np.array([place])) for place in range(len(block.ids)))
        return [result for case in alone for result in self._results_in_own_steps(case)]


def chunk_runner(plan: Plan, run_block: RunBlock, run_train: rig.RunTrain | None = None) -> ChunkRunner:
    """Return a runner for a plan; what runs blocks or trains is asked where a controller is from outside."""
    if plan.own_keys:
        return TrainRunner(plan, run_block, run_train)
    return block_runner(plan, run_block)


def block_runner(
    plan: Plan, run_block: RunBlock, *, as_base: bool = False, detail: Detail = "status"
) -> BlockRunner:
    """Return a runner of cars alone; further arguments as those of its assembler, and its own."""
    assembler = BlockAssembler(plan, as_base=as_base)
    regular = BlockRunner(assembler, rig.run_in_lanes, plan, run_block, detail=detail)
    if not plan.survey:
        return regular
    survey = BlockAssembler(in_survey_steps(plan), as_base=as_base)
    return replace(regular, assembler=survey, biases=biases_by_measure(), regular=regular)


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
