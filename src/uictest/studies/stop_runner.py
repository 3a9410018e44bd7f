"""The stops and bench tests that studies ask for, on the threads of this machine; a stop is run once."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from uictest import campaign, rig
from uictest.scenario import Case, load

if TYPE_CHECKING:
    from uictest.recording import Recording

_SCENARIOS = Path(__file__).parent / "scenarios"

Argument = TypeVar("Argument")
Result = TypeVar("Result")


@dataclass(frozen=True, slots=True)
class Stops:
    """The stops of one case under one seed after the other."""

    case: Case
    stops: Sequence[rig.SimulatedStop]


class StopRunner:
    """Runs what studies ask for.

    Args:
        jobs: threads to simulate on.
    """

    def __init__(self, jobs: int = 1) -> None:
        self._jobs = jobs
        self._stops: dict[tuple[str, int], rig.SimulatedStop] = {}

    def cases(self, scenario: str, *changes: str) -> list[Case]:
        """Return the cases of a scenario of the studies, changed by `key=value` texts as of `--set`."""
        return load([_SCENARIOS / f"{scenario}.yaml"], changes)

    def repeated(self, cases: Sequence[Case], seeds: Sequence[int]) -> list[Stops]:
        """Return the stops, without recording, of every case under every seed of the sensors' noise."""
        wanted = [seeded(case, seed) for case in cases for seed in seeds]
        new = {_key(case): case for case in wanted if _key(case) not in self._stops}
        self._stops.update(zip(new, self.each(_stop, list(new.values())), strict=True))
        return [Stops(case, [self._stops[_key(seeded(case, seed))] for seed in seeds]) for case in cases]

    def recordings(self, cases: Sequence[Case], every: float) -> list[Recording]:
        """Return a recording of the stop of every case, a sample every so many seconds."""
        return self.each(lambda case: _recording(case, every), cases)

    def each(self, work: Callable[[Argument], Result], arguments: Sequence[Argument]) -> list[Result]:
        """Return what `work` makes of each, in order. The compiled rig needs no interpreter's lock."""
        return list(campaign.map_on_threads(work, arguments, jobs=self._jobs))


def seeded(case: Case, seed: int) -> Case:
    """Return a case with another seed of the sensors' noise."""
    return replace(case, scenario=case.scenario.model_copy(update={"seed": seed}))


def _key(case: Case) -> tuple[str, int]:
    return case.id, case.scenario.seed


def _stop(case: Case) -> rig.SimulatedStop:
    return rig.simulate(case)


def _recording(case: Case, every: float) -> Recording:
    recording = rig.simulate(case, record_every=every).recording
    assert recording is not None
    return recording
