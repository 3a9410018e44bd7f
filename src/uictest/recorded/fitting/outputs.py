"""The files of a fit: the scenario with the fitted friction, the numbers, the overlay."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
import yaml

from uictest.core import files
from uictest.core.recording import TIME, Recording, at_instants
from uictest.core.units import KILOMETRE_PER_HOUR
from uictest.judging import evaluation
from uictest.plans import library
from uictest.plans.scenario import EXPANSION_KEYS, PART_KEYS, Case, Scenario
from uictest.plans.scenario.yaml import dotted, quantities_in
from uictest.recorded.field_data import RecordedStop, of_wheelsets
from uictest.recorded.fitting.fit import Fit
from uictest.rig import SimulatedStop

_COMPARED = ("speed", *of_wheelsets("wheel_speed"))


@dataclass(frozen=True, slots=True)
class Agreement:
    """How far the simulated stop follows the recorded one: time in s, distance in m, speed in m/s."""

    recorded_time: float
    simulated_time: float
    recorded_distance: float
    simulated_distance: float
    speed_difference: float

    def __str__(self) -> str:
        """Return the comparison for a reader."""
        speed = self.speed_difference / KILOMETRE_PER_HOUR
        return (
            f"recorded stop {self.recorded_time:.2f} s, {self.recorded_distance:.1f} m;"
            f" simulated {self.simulated_time:.2f} s, {self.simulated_distance:.1f} m;"
            f" train speeds differ by {speed:.2f} km/h (root mean square)"
        )


def overlay(recorded: RecordedStop, simulated: SimulatedStop) -> Recording:
    """Return train and wheel speeds of both stops at the sampling times of the record, m/s."""
    assert simulated.recording is not None
    time, other = np.asarray(recorded.recording[TIME]), simulated.recording
    channels = {TIME: time}
    for name in _COMPARED:
        channels[f"{name}_recorded"] = np.asarray(recorded.recording[name])
        followed = at_instants(other[TIME], other[name], time, holds=False)
        channels[f"{name}_simulated"] = np.where(time > other[TIME][-1], 0.0, followed)
    units = {name: "s" if name == TIME else "m/s" for name in channels}
    return Recording(channels, units)


def agreement(recorded: RecordedStop, simulated: SimulatedStop, both: Recording) -> Agreement:
    """Return the agreement of the two stops."""
    difference = both["speed_recorded"] - both["speed_simulated"]
    time, distance = recorded.standstill or (float("nan"), float("nan"))
    return Agreement(
        time,
        float(simulated.measures.braking_time),
        distance,
        float(simulated.measures.braking_distance),
        float(np.sqrt(np.mean(difference**2))),
    )


SCHEMA: Final = "uictest/fit/1"
_DIGITS: Final = 5
_LONGEST_NAME: Final = 90
"""Letters of the name of a part that a fit writes; chosen."""


def fitted_yaml(case: Case, statements: Mapping[str, str], fit: Fit, scenario: Path, folder: Path) -> str:
    """Return the text of a scenario that extends `scenario` from `folder` and states the fitted friction.

    Args:
        case: the case that was fitted.
        statements: values set on the command line, by dotted key; kept like the case's parameters.
        fit: the fitted values.
        scenario: file of the case.
        folder: folder of the new file.

    Raises ValueError where a value cannot be written below a part that the scenario only refers to.

    """
    ships = library.named_scenario(scenario) != scenario
    content: dict[str, Any] = {
        "schema": "uictest/scenario/1",
        "name": f"{case.scenario.name[:_LONGEST_NAME]}-fitted",
        "title": f"{case.scenario.name} with the friction of a recorded stop",
        "description": "\n".join(["Fitted to a recorded stop.", *map(str, fit.estimates)]),
        "extends": scenario.as_posix() if ships else files.relative_path(scenario, folder),
        "expect": case.scenario.expect.form(),
        **dict.fromkeys(EXPANSION_KEYS),
    }
    for key, value in {**case.parameters, **statements}.items():
        _assign_dotted_key(content, key, yaml.safe_load(value))
    _assign_dotted_key(content, "rail.friction", friction_of(fit, case.scenario))
    _assign_dotted_key(content, "rail.friction_over_time", None)
    if (variation := case.scenario.rail.variation_in_force) is not None:
        numbers = {dotted(key): value.text for key, value in quantities_in(variation)}
        # What the rail was is fitted: nothing of it is left to chance.
        _assign_dotted_key(content, "rail.variation", numbers | {"spread": "0 %"})
    if case.scenario.rail.friction_over_speed_in_force is not None:  # it is in what was fitted
        constant = {"numerator": "1 km/h", "denominator": "1 km/h"}
        _assign_dotted_key(content, "rail.friction_over_speed", constant)
    if fit.pad_factor is not None:
        content.setdefault("brake", {})["system"] = _with_pads(case.scenario, fit.pad_factor.value)
    text: str = yaml.safe_dump(content, sort_keys=False, allow_unicode=True, width=110)
    return text


def friction_of(fit: Fit, scenario: Scenario) -> float | dict[str, Any]:
    """Return the value of `rail.friction`: a number, or steps along the track.

    With only a lower bound, the scenario's own friction stays if it is not below the bound. A stretch that
    no wheelset reached takes the friction of its neighbour.
    """
    levels: list[float] = []
    stated = float(scenario.rail.highest_friction)
    for estimate in fit.friction:
        value = {"found": estimate.value, "at least": max(stated, estimate.value)}.get(estimate.standing)
        levels.append(round(min(value if value is not None else levels[-1], 1.0), _DIGITS))
    if len(levels) == 1:
        return levels[0]
    positions = [min(0.0, fit.breaks[0] - 1.0), *fit.breaks]
    points = [{"position": f"{p:g} m", "friction": mu} for p, mu in zip(positions, levels, strict=True)]
    return {"points": points, "interpolation": "steps"}


def _assign_dotted_key(content: dict[str, Any], key: str, value: Any) -> None:
    names = key.split(".")
    parts = {dotted(part) for part in PART_KEYS}
    for depth in range(1, len(names)):
        if ".".join(names[:depth]) in parts:
            raise ValueError(f"{key}: write the changed part into the scenario first, then fit that")
    for name in names[:-1]:
        content = content.setdefault(name, {})
    content[names[-1]] = value


def _with_pads(scenario: Scenario, factor: float) -> dict[str, Any]:
    system = scenario.brake.system
    if system.name not in library.names("brakes"):
        raise ValueError("pad friction can only be written for a brake system of the library")
    return {
        "extends": system.name,
        "disc": {"pad_friction": round(factor * float(system.disc.pad_friction), _DIGITS)},
    }


def fit_document(fit: Fit, agreement: Agreement, choices: dict[str, str]) -> dict[str, Any]:
    """Return the fitted values, the agreement of the simulated stop and the preparation; NaN as None."""
    results = {"determined": fit.determined, "fit": asdict(fit), "agreement": asdict(agreement)}
    form: dict[str, Any] = evaluation.json_form({"schema": SCHEMA, **results, "preparation": choices})
    return form
