"""Simulate stops again to record them. Stops are reproducible to the bit, so nothing is judged again."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence

from uictest import rig
from uictest.core import recording
from uictest.plans import scenario
from uictest.rig import bench
from uictest.running.campaign.threaded_map import map_on_threads


def shortest_cycle(cases: Iterable[scenario.Case]) -> float:
    """Return the shortest controller cycle of cases, s: a recording at this interval has every command."""
    return min((float(case.scenario.controller.cycle_time) for case in cases), default=math.inf)


def replay(
    cases: Sequence[scenario.Case], *, every: float, jobs: int
) -> Iterator[tuple[scenario.Case, recording.Recording]]:
    """Yield each case with its recording, a sample `every` so many seconds, in the order of the cases."""
    stops = map_on_threads(
        lambda case: rig.simulate(bench.identified(case), record_every=every), cases, jobs=jobs
    )
    for case, stop in zip(cases, stops, strict=True):
        if stop.recording is not None:
            yield case, stop.recording
