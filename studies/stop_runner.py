"""Run the stops and bench tests of studies on threads; each stop is run once."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from hashlib import sha256
from pathlib import Path
from typing import TypeVar

import numpy as np

from uictest import rig
from uictest.core.recording import Recording
from uictest.plans.scenario import Case, load
from uictest.running import campaign

_SCENARIOS = Path(__file__).parent / "scenarios"

_BATCH = 128
"""Stops that a thread runs in lanes at a time."""

Argument = TypeVar("Argument")
Result = TypeVar("Result")


@dataclass(frozen=True, slots=True)
class Stops:
    """The stops of one case, one per seed."""

    case: Case
    stops: Sequence[rig.SimulatedStop]


class StopRunner:
    """Runs the stops of studies, and caches them.

    Args:
        jobs: threads to simulate on.
    """

    def __init__(self, jobs: int = 1) -> None:
        self._jobs = jobs
        self._stops: dict[tuple[str, str], rig.SimulatedStop] = {}
        self.inputs: dict[str, str] = {}
        """Every file that the cases of the study were loaded from -> its SHA-256."""

    def cases(self, scenario: str, *changes: str) -> list[Case]:
        """Return the cases of a scenario of the studies, changed by `key=value` texts as of `--set`."""
        cases = load([_SCENARIOS / f"{scenario}.yaml"], changes)
        for case in cases:
            self.inputs.update(case.inputs)
        return cases

    def repeated(self, cases: Sequence[Case], seeds: Sequence[int]) -> list[Stops]:
        """Return the stops, without recording, of every case under every seed of the sensors' noise."""
        seeded_cases = [seeded(case, seed) for case in cases for seed in seeds]
        new_cases = {_key(case): case for case in seeded_cases if _key(case) not in self._stops}
        self._stops.update(zip(new_cases, self.map(_stop, list(new_cases.values())), strict=True))
        return [Stops(case, [self._stops[_key(seeded(case, seed))] for seed in seeds]) for case in cases]

    def in_lanes(self, cases: Sequence[Case]) -> list[rig.SimulatedStop]:
        """Return the stop, without recording, of every case: for many cases that are run once.

        Stops run side by side in the lanes of a register and have the bits of :func:`uictest.rig.simulate`.
        """
        batches = [cases[start : start + _BATCH] for start in range(0, len(cases), _BATCH)]
        # The first compiles what the threads then share.
        stops = [*map(_side_by_side, batches[:1]), *self.map(_side_by_side, batches[1:])]
        return [stop for batch in stops for stop in batch]

    def recordings(self, cases: Sequence[Case], every: float) -> list[Recording]:
        """Return a recording of the stop of every case, a sample every so many seconds."""
        return self.map(lambda case: _recording(case, every), cases)

    def map(self, work: Callable[[Argument], Result], arguments: Sequence[Argument]) -> list[Result]:
        """Return the result of `work` for each argument, in order; the compiled rig releases the GIL."""
        return list(campaign.map_on_threads(work, arguments, jobs=self._jobs))


def seeded(case: Case, seed: int) -> Case:
    """Return a case with another seed of the sensors' noise."""
    return replace(case, scenario=case.scenario.model_copy(update={"seed": seed}))


def constant_friction(case: Case) -> float:
    """Return the initial friction coefficient of a case whose rail has the same one everywhere."""
    friction = case.scenario.rail.friction
    assert isinstance(friction, float)
    return friction


def _key(case: Case) -> tuple[str, str]:
    """Return what identifies a stop: its id, which seeds the noise, and all of its scenario."""
    return case.id, sha256(case.scenario.model_dump_json().encode()).hexdigest()


def _stop(case: Case) -> rig.SimulatedStop:
    return rig.simulate(case)


def _side_by_side(cases: Sequence[Case]) -> list[rig.SimulatedStop]:
    inputs = [rig.assemble(case) for case in cases]
    points = max(each.rail.shape[1] for each in inputs)
    batch = rig.run_in_lanes(
        np.array([each.parameters for each in inputs]),
        np.array([each.wheelset_parameters for each in inputs]),
        np.array([np.pad(each.rail, ((0, 0), (0, points - each.rail.shape[1]))) for each in inputs]),
    )
    trains, wheelsets = batch.measures.view(np.recarray), batch.wheelset_measures.view(np.recarray)
    return [rig.SimulatedStop(*stop) for stop in zip(trains, wheelsets, strict=True)]


def _recording(case: Case, every: float) -> Recording:
    recording = rig.simulate(case, record_every=every).recording
    assert recording is not None
    return recording
