"""Verdicts of further cases, whose other results are discarded."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from uictest.campaign import map_on_threads
from uictest.sweep.plan.plan import Plan
from uictest.sweep.running.case_blocks import BlockAssembler
from uictest.sweep.running.chunk import ChunkRunner
from uictest.sweep.running.device import Simulate
from uictest.sweep.summaries.frontier import Verdicts

_CASES_AT_ONCE: Final = 256


def verdicts_of(plan: Plan, indices: NDArray[np.int64], simulate: Simulate, jobs: int) -> Verdicts:
    """Return 1 for each case with the given indices that meets its expectation, else 0."""
    runner = ChunkRunner(BlockAssembler(plan), simulate, plan)

    def met(block: NDArray[np.int64]) -> list[bool]:
        return [result.met for result in runner.results(runner.assembler.block(block))]

    blocks = np.array_split(indices, max(jobs, -(-indices.size // _CASES_AT_ONCE)))
    verdicts = map_on_threads(met, [block for block in blocks if block.size], jobs=jobs)
    return np.array([each for block in verdicts for each in block], np.int8)
