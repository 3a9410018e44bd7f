"""One part of a sweep: a fixed stretch of its cases, worked out to the bytes of a file."""

from __future__ import annotations

import io
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from uictest.evaluation import CaseResult
from uictest.sweep.plan.plan import Plan
from uictest.sweep.running.assembling import Assembler, Block
from uictest.sweep.running.judging import judged
from uictest.sweep.running.simulating import Device, Measures, Simulate, simulator
from uictest.sweep.running.table import rows

if TYPE_CHECKING:
    import pyarrow as pa


@dataclass(frozen=True)
class ChunkRunner:
    """Works out cases of one plan; several threads may share one."""

    assembler: Assembler
    simulate: Simulate
    plan: Plan

    def part(self, indices: NDArray[np.int64]) -> bytes:
        """Return the rows of the cases with the given indices as a Parquet file."""
        block = self.assembler.block(indices)
        return parquet_bytes(rows(self.plan, block, self.results(block)))

    def prepare(self) -> None:
        """Compile the rig before several threads ask for it at once."""
        block = self.assembler.block(np.zeros(1, np.int64))
        block.parameters["cycles"] = 1
        self.simulate(block.parameters, block.rail)

    def results(self, block: Block) -> list[CaseResult]:
        """Return the results of a block; whatever goes wrong with a case is its result."""
        places = [place for place, reason in enumerate(block.refused) if not reason]
        if not places:
            return judged(self.assembler, block, [], _none())
        try:
            measures = self.simulate(block.parameters[places], block.rail[places])
        except Exception as error:
            return self._one_by_one(block, error)
        return judged(self.assembler, block, places, measures)

    def _one_by_one(self, block: Block, error: Exception) -> list[CaseResult]:
        """Find out which case the block fell over."""
        if len(block.ids) == 1:
            block.refused[0] = f"{type(error).__name__}: {error}"
            return judged(self.assembler, block, [], _none())
        return [result for place in range(len(block.ids)) for result in self.results(_single(block, place))]


def chunk_runner(plan: Plan, device: Device = "cpu") -> ChunkRunner:
    """Return a worker for a plan."""
    return ChunkRunner(Assembler(plan), simulator(device), plan)


def _none() -> Measures:
    from uictest.measures import STOP_MEASURES, WHEELSET_MEASURES

    return np.zeros(0, STOP_MEASURES), np.zeros((0, 4), WHEELSET_MEASURES)


def _single(block: Block, place: int) -> Block:
    at: Sequence[int] = [place]
    return Block(
        block.indices[at],
        [block.ids[place]],
        {key: [values[place]] for key, values in block.settings.items()},
        block.parameters[at],
        block.rail[at],
        [block.judged_as[place]],
        [block.refused[place]],
    )


def parquet_bytes(table: pa.Table) -> bytes:
    """Return a table as a Parquet file; the same table gives the same bytes."""
    import pyarrow.parquet as pq

    buffer = io.BytesIO()
    pq.write_table(table, buffer, compression="zstd", write_page_checksum=True)
    return buffer.getvalue()
