"""Stops around the slide test: nearby friction and command, on both topologies, under many seeds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from uictest import rig
from uictest.scenario import Case
from uictest.studies.stop_runner import StopRunner

SETTINGS = ("none", "hysteresis", "cylinder", "full")
"""Settings of the compensation."""
FOUR_CALIPER = "four-caliper"
SEEDS = range(10)
_FRICTION_STEPS = (-0.005, 0.0, 0.005)
_COMMANDS = ("95 %", "97.5 %", "100 %")
"""The full command is the highest, so its neighbours are all below it."""
WITHOUT_CALIPER = (2, 3, 4)
"""Modules that are tanks on the rig with one caliper."""


@dataclass(frozen=True, slots=True)
class Point:
    """One place of the neighbourhood: friction and command as written, and the repeats on every rig.

    `stops` holds the four settings of the rig with one caliper by name, and the rig with four calipers.
    """

    friction: str
    command: str
    case: Case
    stops: dict[str, Sequence[rig.SimulatedStop]]

    @property
    def title(self) -> str:
        """Short name for tables and figures."""
        return f"{self.friction}, {self.command}"


def neighbourhood(stop_runner: StopRunner) -> list[Point]:
    """Return the nine points, friction slowest; stops of other studies are not run again."""
    changes = (_frictions(stop_runner), f"brake.command={','.join(_COMMANDS)}")
    one = stop_runner.cases("slide-80", *changes, f"rig.compensation={','.join(SETTINGS)}")
    four = stop_runner.cases("slide-80-four-caliper", *changes)
    repeats = stop_runner.repeated([*one, *four], SEEDS)
    of_one, of_four = repeats[: len(one)], repeats[len(one) :]
    points = []
    for k, reference in enumerate(of_four):
        settings = of_one[k * len(SETTINGS) : (k + 1) * len(SETTINGS)]
        stops = {name: each.stops for name, each in zip(SETTINGS, settings, strict=True)}
        stops[FOUR_CALIPER] = reference.stops
        friction, command = reference.case.parameters.values()
        points.append(Point(friction, command, reference.case, stops))
    return points


def _frictions(stop_runner: StopRunner) -> str:
    calibrated = stop_runner.cases("slide-80")[0].scenario.rail.friction
    assert isinstance(calibrated, float)
    return "rail.friction=" + ",".join(f"{calibrated + step:.4g}" for step in _FRICTION_STEPS)
