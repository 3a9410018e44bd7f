from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pytest

from studies import stop_runner
from studies.neighbourhood import SEEDS, SETTINGS, friction_sweep, neighbourhood
from studies.stop_runner import StopRunner, constant_friction
from uictest.plans.scenario import COMPENSATION_SETTINGS, Case


@pytest.fixture(autouse=True)
def cases_as_stops(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let every stop come out as its case."""

    def judged(cases: Sequence[Case], jobs: int) -> Any:
        return cases

    monkeypatch.setattr(stop_runner, "_judged", judged)


def test_every_setting_of_the_compensation_is_compared() -> None:
    assert tuple(COMPENSATION_SETTINGS) == SETTINGS


def test_nine_points_hold_the_repeats_on_every_rig() -> None:
    points = neighbourhood(StopRunner())
    assert len({point.title for point in points}) == 9
    for point in points:
        assert set(point.stops) == {*COMPENSATION_SETTINGS, "four-caliper"}
        assert all(len(stops) == len(SEEDS) for stops in point.stops.values())


def test_every_stop_of_a_point_has_its_friction_command_and_rig() -> None:
    for point in neighbourhood(StopRunner()):
        for name, cases in point.stops.items():
            scenarios: Any = [case.scenario for case in cases]  # type: ignore[attr-defined]
            assert {each.rail.friction for each in scenarios} == {constant_friction(point.case)}
            assert {each.brake.command.text for each in scenarios} == {point.command}
            assert name in {scenarios[0].rig.compensation, scenarios[0].rig.topology}


def test_the_sweep_is_130_stops_about_the_friction_of_the_slide_test() -> None:
    sweep = friction_sweep(StopRunner())
    calibrated = constant_friction(StopRunner().cases("slide-80")[0])
    steps = [(constant_friction(point.case) - calibrated) * 1000.0 for point in sweep]
    assert steps == pytest.approx(range(-6, 7))
    assert sum(len(point.stops["none"]) for point in sweep) == 130
    assert {point.command for point in sweep} == {"100 %"}
