"""Run one chunk of a sweep and encode its results as Parquet."""

from __future__ import annotations

import io
from collections import namedtuple
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from uictest import rig
from uictest.campaign import ThreadedMap
from uictest.evaluation import CaseResult, error_result, evaluate_simulated
from uictest.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.sweep.plan.plan import Plan
from uictest.sweep.running.case_blocks import BlockAssembler, CaseBlock
from uictest.sweep.running.case_selection import CaseSelection
from uictest.sweep.running.device import Device, Measures, Simulate, simulator
from uictest.sweep.running.table import rows

if TYPE_CHECKING:
    import pyarrow as pa

RunBlock = Callable[[rig.BlockInputs], rig.BlockRun]
"""Simulates a block in which a controller comes from outside: here, or in child processes."""
WriteChunk = Callable[[int, bytes], None]
"""Takes the number of a finished chunk and its results."""
_CHUNKS_AHEAD = 2
"""Chunks that wait or are ready beyond those in progress: bounds memory."""
# Judging reads many fields, and a numpy record takes ten times as long to read as a tuple.
_tuple_of: Any = namedtuple
_Stop = _tuple_of("_Stop", STOP_MEASURES.names)
_Wheelset = _tuple_of("_Wheelset", WHEELSET_MEASURES.names)


@dataclass(frozen=True)
class ChunkRunner:
    """Simulates and judges the cases of one chunk; several threads may share a runner."""

    assembler: BlockAssembler
    simulate: Simulate
    plan: Plan
    run_block: RunBlock

    def run(self, indices: NDArray[np.int64]) -> bytes:
        """Return the rows of the cases with the given indices as a Parquet file."""
        block = self.assembler.block(indices)
        return parquet_bytes(rows(self.plan, block, self.results(block)))

    def prepare(self) -> None:
        """Compile the rig before several threads need it at once."""
        block = self.assembler.block(np.zeros(1, np.int64))
        if any(block.programs):
            rig.load_block(block.programs, block.controllers)
            return
        block.parameters["cycles"] = 1
        self.simulate(block.parameters, block.wheelset_parameters, block.rail, block.controllers)

    def results(self, block: CaseBlock) -> list[CaseResult]:
        """Return the results of a block; an error in a case is its result."""
        places = [place for place, reason in enumerate(block.rejections) if not reason]
        if not places:
            return self._judge(block, [], _no_measures())
        try:
            measures = self._simulated(block, places)
        except Exception as error:
            return self._run_one_by_one(block, error)
        return self._judge(block, places, measures)

    def _simulated(self, block: CaseBlock, places: Sequence[int]) -> Measures:
        """Return the measures of some cases; one whose controller from outside fails becomes a rejection."""
        controllers = [block.controllers[place] for place in places]
        inputs = block.parameters[places], block.wheelset_parameters[places], block.rail[places], controllers
        programs = [block.programs[place] for place in places]
        if not any(programs):
            return self.simulate(*inputs)
        configs = [block.configs[place] for place in places]
        run = self.run_block(rig.BlockInputs(programs, configs, *inputs))
        for place, failure in zip(places, run.failures, strict=True):
            block.rejections[place] = failure
        return run.measures, run.wheelset_measures

    def _run_one_by_one(self, block: CaseBlock, error: Exception) -> list[CaseResult]:
        """Find the case that caused the error of the block."""
        if len(block.ids) == 1:
            block.rejections[0] = f"{type(error).__name__}: {error}"
            return self._judge(block, [], _no_measures())
        return [result for place in range(len(block.ids)) for result in self.results(_single(block, place))]

    def _judge(self, block: CaseBlock, places: Sequence[int], measures: Measures) -> list[CaseResult]:
        """Return the results of all cases; those that were not simulated, or failed, have a rejection."""
        stops = dict(zip(places, zip(*(each.tolist() for each in measures), strict=True), strict=True))
        return [self._judge_case(block, place, stops.get(place)) for place in range(len(block.ids))]

    def _judge_case(self, block: CaseBlock, place: int, stop: Any) -> CaseResult:
        case = self.assembler.case(block, place)
        if block.rejections[place]:
            return error_result(case, block.rejections[place])
        try:
            wheelsets = [_Wheelset(*wheelset) for wheelset in stop[1]]
            return evaluate_simulated(case, _Stop(*stop[0]), wheelsets, explain=False)
        except Exception as error:  # a case that cannot be judged becomes a row and does not end the sweep
            return error_result(case, f"{type(error).__name__}: {error}")


def chunk_runner(plan: Plan, run_block: RunBlock, device: Device = "cpu") -> ChunkRunner:
    """Return a runner for a plan; `run_block` is asked only where a controller comes from outside."""
    return ChunkRunner(BlockAssembler(plan), simulator(device), plan, run_block)


def run_on_threads(
    runner: ChunkRunner, selection: CaseSelection, numbers: Sequence[int], jobs: int, write_chunk: WriteChunk
) -> None:
    """Run the chunks with the given numbers; `write_chunk` gets each in this thread, in this order.

    After any exception, KeyboardInterrupt included, the chunks that `write_chunk` got are kept.
    """
    jobs = min(jobs, len(numbers)) or 1
    with ThreadedMap(
        lambda number: runner.run(selection.chunk(number)), numbers, jobs=jobs, pending=jobs + _CHUNKS_AHEAD
    ) as contents:
        for number, content in zip(numbers, contents, strict=True):
            write_chunk(number, content)


def _no_measures() -> Measures:
    return np.zeros(0, STOP_MEASURES), np.zeros((0, 4), WHEELSET_MEASURES)


def _single(block: CaseBlock, place: int) -> CaseBlock:
    at: Sequence[int] = [place]
    return CaseBlock(
        block.indices[at],
        [block.ids[place]],
        {key: [values[place]] for key, values in block.settings.items()},
        block.parameters[at],
        block.wheelset_parameters[at],
        block.rail[at],
        [block.controllers[place]],
        [block.programs[place]],
        [block.configs[place]],
        [block.judged_as[place]],
        [block.rejections[place]],
    )


def parquet_bytes(table: pa.Table) -> bytes:
    """Return a table as a Parquet file; the same table gives the same bytes."""
    import pyarrow.parquet as pq

    buffer = io.BytesIO()
    pq.write_table(table, buffer, compression="zstd", write_page_checksum=True)
    return buffer.getvalue()
