"""What reports say of simulated cases: title, tags and the main settings, in words."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from uictest import report
from uictest.plans.scenario import Case, Coupler, ExternalController, Scenario, is_changed, yaml


def descriptions_of(cases: Iterable[Case]) -> dict[str, report.CaseDescription]:
    """Return title, tags and the main settings of every case by its id."""
    scenarios = {case.id: case.scenario for case in cases}
    return {
        case_id: report.CaseDescription(scenario.title, tuple(scenario.tags), _settings(scenario))
        for case_id, scenario in scenarios.items()
    }


def _settings(scenario: Scenario) -> dict[str, str]:
    brake, rail, rig = scenario.brake, scenario.rail, scenario.rig
    speed = scenario.initial_speed.text
    if scenario.drag is not None:
        speed += f", {scenario.drag.speed.text} held for {scenario.drag.duration.text}"
    if scenario.until is not None:
        speed += f", until {scenario.until.text}"
    return {
        "vehicle": _part_name(scenario.vehicle),
        **({"train": _train_in_words(coupler, brake.transmission)} if (coupler := scenario.coupler) else {}),
        "initial speed": speed,
        "brake": f"{_part_name(brake.system)}, position {brake.position}, {brake.command_text}",
        "rail": f"{_part_name(rail.condition)}, friction {_friction(scenario)},"
        f" gradient {rail.gradient.text}",
        "WSP": f"{rig.wsp}, controller {_controller(scenario)}",
        "rig": f"{rig.topology}, compensation {_part_name(rig.compensation_model)},"
        f" setting {rig.compensation}",
        "criteria": ", ".join(profile.name for profile in scenario.criteria),
    }


def _train_in_words(coupler: Coupler, line: Any) -> str:
    numbers = f"couplers {coupler.stiffness.text}, {coupler.damping.text}, {coupler.distance.text} apart"
    command = "a wire" if line in (None, "wire") else f"a pipe at {line.pipe.text}"
    return f"{numbers}; command along {command}"


def _part_name(part: yaml.Part) -> str:
    """Return the name of a part, and whether it differs from the part that it extends."""
    return f"{part.label} (changed)" if is_changed(part) else part.label


def _friction(scenario: Scenario) -> str:
    rail = scenario.rail
    if rail.friction is None:
        text = rail.condition.friction.text
    else:
        text = getattr(rail.friction, "text", "along the track")
    return text if rail.friction_over_time is None else f"{text}, changing with time"


def _controller(scenario: Scenario) -> str:
    """Return the name of the controller; of one from outside, its version and what is loaded, too."""
    controller = scenario.controller
    if not isinstance(controller, ExternalController):
        return _part_name(controller)
    version = f" {controller.version}" if controller.version else ""
    return f"{_part_name(controller)}{version} ({controller.kind} {controller.reference})"
