"""Stops around the slide test: nearby friction and command, on both topologies, under many seeds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from uictest import rig
from uictest.plans.scenario import COMPENSATION_SETTINGS, Case
from uictest.studies.stop_runner import StopRunner, constant_friction

SETTINGS = tuple(COMPENSATION_SETTINGS)
"""Settings of the compensation."""
FOUR_CALIPER = "four-caliper"
SEEDS = range(10)
_FRICTION_STEPS = (-0.005, 0.0, 0.005)
_COMMANDS = ("95 %", "97.5 %", "100 %")
"""The full command is the highest, so its neighbours are all below it."""
_SWEPT_STEPS = tuple(0.001 * k for k in range(-6, 7))
_SWEPT_SETTINGS = ("none", "full", "thermal")
WITHOUT_CALIPER = (2, 3, 4)
"""Modules that are tanks on the rig with one caliper."""


@dataclass(frozen=True, slots=True)
class Point:
    """One place of the neighbourhood: friction and command as written, and the repeats on every rig.

    `stops` holds the settings of the rig with one caliper by name, and the rig with four calipers.
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
    """Return the nine points of friction and command on all rigs, friction slowest."""
    return _points(stop_runner, _FRICTION_STEPS, _COMMANDS, SETTINGS)


def friction_sweep(stop_runner: StopRunner) -> list[Point]:
    """Return thirteen frictions at full command, with and without compensation and with four calipers."""
    return _points(stop_runner, _SWEPT_STEPS, _COMMANDS[-1:], _SWEPT_SETTINGS)


def _points(
    stop_runner: StopRunner, steps: Sequence[float], commands: Sequence[str], settings: Sequence[str]
) -> list[Point]:
    """Return a point for each step of friction from the calibrated one, and each command."""
    changes = (_frictions(stop_runner, steps), f"brake.command={','.join(commands)}")
    rigs = {name: stop_runner.cases("slide-80", *changes, f"rig.compensation={name}") for name in settings}
    rigs[FOUR_CALIPER] = stop_runner.cases("slide-80-four-caliper", *changes)
    repeats = {name: stop_runner.repeated(cases, SEEDS) for name, cases in rigs.items()}
    return [
        Point(
            f"{constant_friction(case):.4g}",
            case.scenario.brake.command.text,
            case,
            {name: of_rig[k].stops for name, of_rig in repeats.items()},
        )
        for k, case in enumerate(rigs[FOUR_CALIPER])
    ]


def _frictions(stop_runner: StopRunner, steps: Sequence[float]) -> str:
    calibrated = constant_friction(stop_runner.cases("slide-80")[0])
    return "rail.friction=" + ",".join(f"{calibrated + step:.4g}" for step in steps)
