"""Errors of each setting of the compensation, compared with a caliper under the same valve commands."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from uictest import scenario
from uictest.recording import Recording
from uictest.studies.neighbourhood import SETTINGS, WITHOUT_CALIPER, Point
from uictest.studies.replay import CYCLE, maximum_pressure, replayed
from uictest.studies.stop_runner import StopRunner, seeded
from uictest.units import PERCENT

REPLAYED_SEEDS = range(2)
UNITS_OF_ERRORS = {"pressure_error": "% of maximum pressure", "force_error": "% of largest force"}
_FILTERED = frozenset({"cylinder", "full"})


@dataclass(frozen=True, slots=True)
class ModelError:
    """Largest errors of one setting at one point, along the commands of one wheelset, one for each seed."""

    key: str
    setting: str
    friction: str
    command: str
    wheelset: int
    values: Sequence[float]


def model_errors(stop_runner: StopRunner, points: Sequence[Point]) -> list[ModelError]:
    """Return pressure and force errors of every setting along the commands of the rig with four calipers."""
    cases = [seeded(point.case, seed) for point in points for seed in REPLAYED_SEEDS]
    stops = stop_runner.recordings(cases, CYCLE)
    work = [
        (case, stop, wheelset)
        for case, stop in zip(cases, stops, strict=True)
        for wheelset in WITHOUT_CALIPER
    ]
    errors = iter(stop_runner.map(lambda arguments: _errors(*arguments), work))
    at = {
        (point.title, seed, wheelset): next(errors)
        for point in points
        for seed in REPLAYED_SEEDS
        for wheelset in WITHOUT_CALIPER
    }
    return [
        ModelError(
            key,
            setting,
            point.friction,
            point.command,
            wheelset,
            [at[point.title, seed, wheelset][key, setting] for seed in REPLAYED_SEEDS],
        )
        for key in UNITS_OF_ERRORS
        for setting in SETTINGS
        for point in points
        for wheelset in WITHOUT_CALIPER
    ]


def _errors(case: scenario.Case, stop: Recording, wheelset: int) -> dict[tuple[str, str], float]:
    """Return the largest errors in %, by key and setting."""
    recording = replayed(case, stop, wheelset)
    top, cylinder = maximum_pressure(case), recording["tank_pressure_1"]
    measured = recording["clamping_force_1"]
    errors = {}
    for setting in SETTINGS:
        channel = "cylinder_pressure_2" if setting in _FILTERED else "tank_pressure_2"
        pressure = np.abs(recording[channel] - cylinder).max() / top
        force = np.abs(recording[f"computed_force_{setting}_2"] - measured).max() / measured.max()
        errors["pressure_error", setting] = float(pressure) / PERCENT
        errors["force_error", setting] = float(force) / PERCENT
    return errors
