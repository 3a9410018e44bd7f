"""The scenarios that come with the project."""

from pathlib import Path

import pytest

from uictest.plans.scenario import COMPENSATION_SETTINGS, load
from uictest.plans.scenario.parts.rail import FrictionProfile

FOLDER = Path(__file__).parents[2] / "scenarios"


@pytest.fixture(scope="module")
def cases():
    return {case.id: case for case in load([FOLDER])}


def test_every_kind_of_stop_is_there(cases):
    assert list(cases) == [
        "cleaned-rail-120",
        *(f"cleaned-rail-80[carry_over={share}]" for share in ("0", "0.5", "1")),
        "dry-120",
        *(f"fade-160[initial_disc_temperature={hot}degC]" for hot in (20, 250, 400)),
        "friction-step-120",
        "low-adhesion-80",
        *(f"radius-80[configured_radius={radius}m]" for radius in ("0.43", "0.4214")),
        "slide-80-four-caliper",
        *(f"slide-80[compensation={setting}]" for setting in COMPENSATION_SETTINGS),
        "slip-120",
        *(f"wet-80-command[command={command}]" for command in (80, 90, 100)),
        *(f"wet-80-friction[friction={friction}]" for friction in ("0.09", "0.10", "0.11", "0.12")),
        "wsp-bypassed-80",
    ]


@pytest.mark.parametrize(
    "path",
    [path for path in sorted(FOLDER.glob("*.yaml")) if not {".sweep", ".series"} & set(path.suffixes)],
    ids=lambda path: path.stem,
)
def test_a_file_is_named_after_its_scenario_and_explains_itself(path):
    first = load([path])[0].scenario
    assert path.read_text().startswith("# yaml-language-server: $schema=../schema/scenario.schema.json\n")
    assert first.name == path.stem
    assert first.title
    assert first.description
    assert first.tags


def test_the_two_tests_of_the_leaflet_start_at_120_in_position_r(cases):
    dry, slip = cases["dry-120"].scenario, cases["slip-120"].scenario
    for scenario in (dry, slip):
        assert scenario.initial_speed == pytest.approx(120 / 3.6)
        assert (scenario.brake.position, scenario.brake.command) == ("R", 1.0)
        assert "uic-541-05-appendix-b" in [each.name for each in scenario.criteria]
    assert dry.rail.condition.name == "dry"
    assert slip.rail.condition.name == "wet"


def test_the_slide_tests_differ_in_the_rig_alone(cases):
    one, four = cases["slide-80[compensation=full]"].scenario, cases["slide-80-four-caliper"].scenario
    assert (one.rig.topology, four.rig.topology) == ("one-caliper", "four-caliper")
    for part in ("vehicle", "brake", "rail", "controller", "initial_speed", "seed"):
        assert getattr(one, part) == getattr(four, part)


def test_only_three_scenarios_are_not_expected_to_pass(cases):
    expected = {case.id: case.scenario.expect for case in cases.values() if case.scenario.expect != "pass"}
    assert expected == {
        "cleaned-rail-120": "invalid",
        "low-adhesion-80": "fail",
        "wsp-bypassed-80": "fail",
    }
    assert cases["wsp-bypassed-80"].scenario.rig.wsp == "bypassed"


def test_the_change_of_friction_is_sudden(cases):
    friction = cases["friction-step-120"].scenario.rail.friction
    assert isinstance(friction, FrictionProfile)
    assert friction.interpolation == "steps"
    assert min(point.friction for point in friction.points) < 0.1 < friction.points[0].friction


TRAM = """\
  body: {mass: 6 t, pitch_inertia: 4e4 kg m2, height: 1.2 m}
  bogie: {mass: 1500 kg, pitch_inertia: 500 kg m2, height: 0.4 m, half_wheelbase: 0.9 m}
  half_pivot_distance: 3 m
  wheelset: {mass: 600 kg, rotational_inertia: 25 kg m2, radius: 0.3 m}
  primary: {longitudinal_stiffness: 3 MN/m, vertical_stiffness: 1 MN/m}
  secondary: {longitudinal_stiffness: 100 kN/m, vertical_stiffness: 200 kN/m}
"""
LOCOMOTIVE = """\
  body: {mass: 52 t, pitch_inertia: 1e6 kg m2, height: 1.8 m}
  bogie: {mass: 8 t, pitch_inertia: 1e4 kg m2, height: 0.65 m, half_wheelbase: 1.5 m}
  half_pivot_distance: 5 m
  wheelset: {mass: 4 t, rotational_inertia: 600 kg m2, radius: 0.625 m}
  primary: {longitudinal_stiffness: 60 MN/m, vertical_stiffness: 2 MN/m}
  secondary: {longitudinal_stiffness: 300 kN/m, vertical_stiffness: 600 kN/m}
  traction_link: {stiffness: 50 MN/m, damping: 200 kN s/m}
"""
EMPTY_WAGON = """\
  body: {mass: 8 t, pitch_inertia: 1.2e5 kg m2, height: 1.2 m}
  bogie: {mass: 2 t}
  wheelset: {mass: 1200 kg, rotational_inertia: 100 kg m2, radius: 0.46 m}
  primary: {longitudinal_stiffness: 100 MN/m, vertical_stiffness: 5 MN/m}
  secondary: {longitudinal_stiffness: 10 MN/m, vertical_stiffness: 1 MN/m}
"""


@pytest.mark.parametrize("car", [TRAM, LOCOMOTIVE, EMPTY_WAGON], ids=["tram", "locomotive", "empty wagon"])
def test_cars_from_trams_to_locomotives_are_plausible(loaded, head, car):
    (case,) = loaded(f"{head}vehicle:\n  extends: intercity-180\n{car}simulation: {{time_step: 1 ms}}\n")
    assert case.scenario.vehicle.total_mass > 10_000.0
