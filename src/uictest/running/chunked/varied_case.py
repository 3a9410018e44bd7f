"""One case, run with other values of some of its numbers and under other seeds."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

import numpy as np

from uictest import rig
from uictest.judging.evaluation import CaseResult
from uictest.plans.scenario import Case
from uictest.plans.sweeps import Column, ListedGroup, ParameterValue, Plan, value_at
from uictest.running.campaign import ThreadedMap
from uictest.running.chunked.case_blocks import BlockAssembler
from uictest.running.chunked.chunk import BlockRunner, RunBlock
from uictest.running.chunked.scenario_function import ScenarioVariants

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

    """

    case: Case
    keys: Sequence[str]
    jobs: int = 1
    run_block: RunBlock = rig.run_block

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
            # Judged as the case itself: numbers of its parts are read for the words of a reason alone.
            block = replace(block, judged_as=ScenarioVariants(self.case.scenario, {}, places.size))
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
        plan = Plan(self.case.id, "", "", self.case, (ListedGroup(keys, (nominal,)),), {})
        return BlockRunner(
            BlockAssembler(plan, noise_of_base=True),
            rig.run_in_lanes,
            plan,
            self.run_block,
            detail="readings",
        )
