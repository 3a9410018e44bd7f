"""What a criterion may ask of the circumstances of a stop before it judges it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from uictest.scenario import Scenario


@dataclass(frozen=True, slots=True)
class TestConditions:
    """The settings of a stop. `command` is a share of full service, `gradient` a share, positive uphill."""

    rail_condition: str
    wsp: str
    position: str
    command: float
    gradient: float
    topology: str


def test_conditions_of(scenario: Scenario) -> TestConditions:
    """Return the circumstances a resolved scenario asks for."""
    return TestConditions(
        rail_condition=scenario.rail.condition.name,
        wsp=scenario.rig.wsp,
        position=scenario.brake.position,
        command=float(scenario.brake.command),
        gradient=float(scenario.rail.gradient),
        topology=scenario.rig.topology,
    )
