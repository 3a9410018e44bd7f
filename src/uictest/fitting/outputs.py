"""The files of a fit: the scenario with the fitted friction, and the numbers as JSON."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any, Final

import yaml

from uictest import evaluation, library
from uictest.fitting.estimate import Fit
from uictest.fitting.overlay import Agreement
from uictest.scenario import EXPANSION_KEYS, PART_KEYS, Case, Scenario
from uictest.scenario.yaml import dotted

SCHEMA: Final = "uictest/fit/1"
_DIGITS: Final = 5
_LONGEST_NAME: Final = 90


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
    content: dict[str, Any] = {
        "schema": "uictest/scenario/1",
        "name": f"{case.scenario.name[:_LONGEST_NAME]}-fitted",
        "title": f"{case.scenario.name} with the friction of a recorded stop",
        "description": "\n".join(_account(fit)),
        "extends": Path(os.path.relpath(scenario, folder)).as_posix(),
        "expect": case.scenario.expect,
        **dict.fromkeys(EXPANSION_KEYS),
    }
    for key, value in {**case.parameters, **statements}.items():
        _assign(content, key, yaml.safe_load(value))
    _assign(content, "rail.friction", friction_of(fit, case.scenario))
    _assign(content, "rail.friction_over_time", None)
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
    own = float(scenario.rail.highest_friction)
    for estimate in fit.friction:
        value = {"found": estimate.value, "at least": max(own, estimate.value)}.get(estimate.standing)
        levels.append(round(min(value if value is not None else levels[-1], 1.0), _DIGITS))
    if len(levels) == 1:
        return levels[0]
    places = [min(0.0, fit.breaks[0] - 1.0), *fit.breaks]
    points = [{"position": f"{p:g} m", "friction": mu} for p, mu in zip(places, levels, strict=True)]
    return {"points": points, "interpolation": "steps"}


def _account(fit: Fit) -> list[str]:
    pads = [] if fit.pad_factor is None else [fit.pad_factor]
    return ["Fitted to a recorded stop.", *(str(estimate) for estimate in (*fit.friction, *pads))]


def _assign(content: dict[str, Any], key: str, value: Any) -> None:
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
    document = {
        "schema": SCHEMA,
        "determined": fit.determined,
        "fit": asdict(fit),
        "agreement": asdict(agreement),
        "preparation": choices,
    }
    form: dict[str, Any] = evaluation.json_form(document)
    return form
