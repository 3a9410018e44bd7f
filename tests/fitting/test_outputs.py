"""The scenario that a fit leaves: its friction and its name."""

import pytest

from uictest.plans.scenario import load
from uictest.recorded.field_data import stated_case
from uictest.recorded.fitting.fit import Estimate, Fit
from uictest.recorded.fitting.outputs import fitted_yaml, friction_of

NAN = float("nan")
HEAD = "schema: uictest/scenario/1\nname: {name}\ninitial_speed: 80 km/h\n"


def fit(*estimates, breaks=()):
    """Return a fit with these standings and values, one for each stretch."""
    found = [Estimate("friction", standing, value, NAN, 1) for standing, value in estimates]
    return Fit(breaks, tuple(found), None, 0.001)


@pytest.fixture
def case():
    """A stop on a rail of friction 0.3, as far as its scenario knows."""
    return stated_case("guess", 80.0 / 3.6, ["rail.condition=wet", "rail.friction=0.3"])


@pytest.mark.parametrize(
    ("estimate", "friction"),
    [
        (("found", 0.0712345678), 0.07123),
        (("at least", 0.2), 0.3),
        (("at least", 0.4), 0.4),
        (("found", 1.2), 1.0),
    ],
)
def test_friction_is_what_was_found_or_the_scenarios_own_unless_it_is_higher(case, estimate, friction):
    """A scenario takes no friction above 1."""
    assert friction_of(fit(estimate), case.scenario) == friction


def test_a_stretch_that_no_wheelset_reached_takes_its_neighbours_friction(case):
    fitted = fit(("found", 0.07), ("not reached", NAN), ("found", 0.1), breaks=(50.0, 120.0))
    assert friction_of(fitted, case.scenario) == {
        "points": [
            {"position": "0 m", "friction": 0.07},
            {"position": "50 m", "friction": 0.07},
            {"position": "120 m", "friction": 0.1},
        ],
        "interpolation": "steps",
    }


def test_a_stretch_that_begins_behind_the_brake_command_has_one_before_it(case):
    points = friction_of(fit(("found", 0.07), ("found", 0.1), breaks=(-20.0,)), case.scenario)
    assert [each["position"] for each in points["points"]] == ["-21 m", "-20 m"]


def test_a_fitted_rail_varies_no_more_at_random(tmp_path):
    """What it was is in the friction that was found."""
    path = tmp_path / "own.yaml"
    path.write_text(HEAD.format(name="own") + "rail: {condition: wet-varied}\n", "utf-8")
    [case] = load([path])
    fitted = tmp_path / "fitted.yaml"
    fitted.write_text(fitted_yaml(case, {}, fit(("found", 0.07)), path, tmp_path), "utf-8")
    [read] = load([fitted])
    assert case.scenario.rail.variation_in_force is not None
    assert read.scenario.rail.variation_in_force is None
    assert friction_of(fit(("at least", 0.2)), case.scenario) == 0.3


@pytest.mark.parametrize("length", [5, 100])
def test_a_fitted_scenario_has_a_name_that_scenarios_can_have(tmp_path, length):
    name = "s" * length
    path = tmp_path / "own.yaml"
    path.write_text(HEAD.format(name=name) + "rail: {condition: wet}\n", "utf-8")
    [case] = load([path])
    fitted = tmp_path / "fitted.yaml"
    fitted.write_text(fitted_yaml(case, {}, fit(("found", 0.07)), path, tmp_path), "utf-8")
    [read] = load([fitted])
    assert read.scenario.name == f"{name[:90]}-fitted"
    assert read.scenario.rail.friction == 0.07
