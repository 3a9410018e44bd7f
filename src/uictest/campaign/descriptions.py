"""What cases are about, taken from their scenarios."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from uictest import report
from uictest.scenario import yaml

if TYPE_CHECKING:
    from uictest.scenario import Case, Scenario


def subjects_of(cases: Iterable[Case]) -> dict[str, report.CaseDescription]:
    """Return the subject of every case by its id."""
    return {case.id: subject_of(case.scenario) for case in cases}


def subject_of(scenario: Scenario) -> report.CaseDescription:
    """Return title, tags and the settings that tell one stop from another."""
    return report.CaseDescription(scenario.title, tuple(scenario.tags), _settings(scenario))


def _settings(scenario: Scenario) -> dict[str, str]:
    brake, rail, rig = scenario.brake, scenario.rail, scenario.rig
    return {
        "vehicle": _named(scenario.vehicle),
        "initial speed": scenario.initial_speed.text,
        "brake": f"{_named(brake.system)}, position {brake.position}, {brake.command.text}",
        "rail": f"{_named(rail.condition)}, friction {_friction(scenario)}, gradient {rail.gradient.text}",
        "WSP": f"{rig.wsp}, controller {_named(scenario.controller)}",
        "rig": f"{rig.topology}, compensation {_named(rig.compensation_model)}, setting {rig.compensation}",
        "criteria": ", ".join(profile.name for profile in scenario.criteria),
    }


def _named(part: yaml.Part) -> str:
    """Return the name of a part, and whether it is another than the part of that name in the library."""
    from uictest.scenario import is_changed

    return f"{part.name} (changed)" if is_changed(part) else part.name


def _friction(scenario: Scenario) -> str:
    rail = scenario.rail
    if rail.friction is None:
        text = rail.condition.friction.text
    else:
        text = getattr(rail.friction, "text", "along the track")
    return text if rail.friction_over_time is None else f"{text}, changing with time"
