"""Cases as they come out, also of stops that are repeated."""

import hashlib
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings, strategies as st

from uictest.plans.scenario import Quantity, ScenarioErrors, ShareOfStops, load
from uictest.plans.scenario.parts.rail import FrictionProfile


def test_defaults_are_filled_in(loaded, head):
    (case,) = loaded(head)
    scenario = case.scenario
    assert (scenario.brake.command, scenario.brake.position) == (1.0, "R")
    assert (scenario.rail.friction, scenario.rail.gradient) == (None, 0.0)
    assert (scenario.rig.topology, scenario.rig.compensation, scenario.rig.wsp) == (
        "one-caliper",
        "thermal",
        "active",
    )
    assert (str(scenario.expect), scenario.seed) == ("pass", 0)
    assert (scenario.simulation.time_step, scenario.simulation.maximum_duration) == (0.0005, 180.0)
    assert scenario.brake.command.source == "default"
    assert scenario.initial_speed.source == "scenario"
    assert (scenario.matrix, scenario.zip, scenario.include, scenario.exclude) == (None, None, None, None)


def test_friction_is_a_number_or_points(loaded, head):
    points = (
        "{interpolation: steps, points: [{position: 0 m, friction: 0.2}, {position: 1 km, friction: 0.08}]}"
    )
    (number,) = loaded(head + "rail: {friction: 0.10}\n")
    (profile,) = loaded(head + f"rail: {{friction: {points}}}\n")
    assert isinstance(number.scenario.rail.friction, Quantity)
    assert number.scenario.rail.friction.text == "0.10"
    assert isinstance(profile.scenario.rail.friction, FrictionProfile)
    assert profile.scenario.rail.friction.interpolation == "steps"
    assert [point.position for point in profile.scenario.rail.friction.points] == [0.0, 1000.0]
    assert profile.scenario.rail.highest_friction == 0.2


def test_a_case_has_the_digest_of_its_bytes_cannot_be_changed_and_shares_its_parts(loaded, head):
    (case,) = loaded(head)
    with pytest.raises(Exception, match="frozen"):
        case.scenario.seed = 1
    assert case.inputs["stop.yaml"] == hashlib.sha256(head.encode()).hexdigest()
    assert case.path == Path("stop.yaml")
    first, second = loaded(head + "matrix: {seed: [1, 2]}\n")
    assert first.scenario.vehicle is second.scenario.vehicle


LINES = (
    *("schema: uictest/scenario/1\n", "name: stop\n", "initial_speed: 120 km/h\n", "extends: stop.yaml\n"),
    *("matrix:\n", "  seed: [1, 2]\n", "rail: {friction: 0.1}\n", "vehicle:\n", "  extends: crh380a\n"),
    *("brake: {command: 90 %}\n", "include: [{seed: 1}]\n", "criteria: []\n", "---\n", "1e9999999\n"),
)
FRAGMENTS = st.sampled_from((*LINES, "? ", "- ", ": ", "&a ", "*a", "!!x ", *"{}[]'\"|>%@#\t\u2028"))


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.binary(max_size=200) | st.lists(FRAGMENTS, max_size=12).map(lambda parts: "".join(parts).encode()))
def test_any_bytes_are_cases_or_scenario_errors(write, content):
    path = write("stop.yaml", content)
    try:
        cases = load([path])
    except ScenarioErrors as errors:
        assert errors.diagnostics
        assert str(errors).replace("\n", "").isprintable()
    else:
        assert len({case.id for case in cases}) == len(cases) >= 1


LAST = 2**32 - 1
"""The largest seed."""


@pytest.mark.parametrize(
    ("text", "overrides", "repeat", "outcome"),
    [
        ("", [], 1, "all"),
        ("repeat: 10\noutcome_of_repeats: median", [], 10, "median"),
        ("repeat: 10", ["repeat=3"], 3, "all"),
        (f"seed: {LAST - 9}\nrepeat: 10", [], 10, "all"),  # the last seed is the largest
    ],
)
def test_one_stop_unless_the_file_says_more(loaded, head, text, overrides, repeat, outcome):
    (case,) = loaded(head + text, *overrides)
    assert (case.scenario.repeat, case.scenario.outcome_of_repeats) == (repeat, outcome)


def test_a_share_of_the_stops(loaded, head):
    (case,) = loaded(head + "repeat: 10\noutcome_of_repeats: {at_least: 90 %}")
    share = case.scenario.outcome_of_repeats
    assert isinstance(share, ShareOfStops)
    assert share.at_least == pytest.approx(0.9)
