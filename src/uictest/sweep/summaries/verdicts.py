"""Verdicts of further cases, of which nothing else is kept."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from typing import Final

import numpy as np
from numpy.typing import NDArray

from uictest.sweep.plan.plan import Plan
from uictest.sweep.running.assembling import Assembler
from uictest.sweep.running.chunk import ChunkRunner
from uictest.sweep.running.simulating import Simulate
from uictest.sweep.summaries.frontier import Verdicts

_AT_ONCE: Final = 256


def verdicts_of(plan: Plan, indices: NDArray[np.int64], simulate: Simulate, jobs: int) -> Verdicts:
    """Return 1 for each case with the given indices that meets its expectation, else 0."""
    worker = ChunkRunner(Assembler(plan), simulate, plan)

    def met(some: NDArray[np.int64]) -> list[bool]:
        return [result.met for result in worker.results(worker.assembler.block(some))]

    stretches = np.array_split(indices, max(jobs, -(-indices.size // _AT_ONCE)))
    with ThreadPoolExecutor(max_workers=jobs) as pool:
        found = [each for some in pool.map(met, [part for part in stretches if part.size]) for each in some]
    return np.array(found, np.int8)
