"""Stops around the slide test, and their valve actuations by the origin of the force."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

import numpy as np
from numpy.typing import NDArray

from studies.stop_runner import StopRunner, constant_friction
from uictest import Case, CaseResult

SETTINGS = ("none", "hysteresis", "cylinder", "full", "thermal")
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
    stops: dict[str, Sequence[CaseResult]]

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
    calibrated = constant_friction(stop_runner.cases("slide-80")[0])
    frictions = [f"{calibrated + step:.4g}" for step in steps]
    changes = {"rail.friction": frictions, "brake.command": commands}
    rigs = {name: stop_runner.cases("slide-80", {**changes, "rig.compensation": name}) for name in settings}
    rigs[FOUR_CALIPER] = stop_runner.cases("slide-80-four-caliper", changes)
    repeats = {name: stop_runner.repeated(cases, SEEDS) for name, cases in rigs.items()}
    return [
        Point(
            f"{constant_friction(case):.4g}",
            case.scenario.brake.first_command.text,
            case,
            {name: of_rig[k].stops for name, of_rig in repeats.items()},
        )
        for k, case in enumerate(rigs[FOUR_CALIPER])
    ]


Counts = NDArray[np.float64]
"""Actuations in repeats of a stop, in the order of their seeds."""

COUNTED: Final = MappingProxyType(
    {
        "caliper": ("full", 1),
        "none": ("none", 2),
        "full": ("full", 2),
        "thermal": ("thermal", 2),
        "reference": (FOUR_CALIPER, 2),
    }
)
"""Rig (or setting of the rig with one caliper) and module, 1 to 4, whose actuations each name stands for."""
PAPER: Final = MappingProxyType({"caliper": 11, "none": 21, "full": 11})
"""Counts in one stop, stated by Lee and Kang (2015)."""
BANDS: Final = MappingProxyType({"caliper": (10.0, 12.0), "none": (19.0, 23.0), "full": (10.0, 12.0)})
"""Bands about the paper's counts, both ends included; chosen."""
APART: Final = 1.3
"""Ratio above which the actuations without compensation are clearly more than those with it; chosen."""


def counts(stops: Mapping[str, Sequence[CaseResult]]) -> dict[str, Counts]:
    """Return every count of :data:`COUNTED` in the repeats of a stop on every rig."""
    return {key: _of_module(stops[name], module) for key, (name, module) in COUNTED.items()}


def mean_counts(stops: Sequence[CaseResult]) -> Counts:
    """Return the actuations per wheelset in repeats of a stop, mean of modules 2 to 4."""
    return np.asarray(np.mean([_of_module(stops, module) for module in WITHOUT_CALIPER], axis=0))


def in_order(caliper: Counts, compensated: Counts, none: Counts) -> NDArray[np.bool_]:
    """Return in which repeats none is clearly above the compensated count, and farther from the caliper's."""
    return (none > APART * compensated) & (abs(compensated - caliper) < abs(none - caliper))


def in_bands(counts: Mapping[str, Counts]) -> NDArray[np.bool_]:
    """Return in which repeats all three counts of the paper lie in their bands."""
    within = [(counts[key] >= lower) & (counts[key] <= upper) for key, (lower, upper) in BANDS.items()]
    return np.asarray(np.all(within, axis=0))


def _of_module(stops: Sequence[CaseResult], module: int) -> Counts:
    return np.array([float(stop.wheelsets[module - 1]["valve_actuations"]) for stop in stops])
