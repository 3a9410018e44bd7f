"""What the cases of a sweep are expected to come to."""

import pytest

from uictest.plans.scenario import PASS, Expectation

STOP = """\
schema: uictest/scenario/1
name: stop
initial_speed: 30 km/h
rail: {condition: wet, friction: 0.1}
criteria: [uictest-stop]
"""
NAMED = Expectation("fail", ("locked-wheels",))


@pytest.mark.parametrize(
    ("text", "overrides", "expected"),
    [
        ("matrix: {rail.friction: [0.05, 0.1]}\n", [], NAMED),
        # Where controllers are set nothing is allowed: no case of a sweep is listed with what it misses.
        ("matrix: {controller: [threshold, slip-band]}\n", [], PASS),
        ("matrix: {controller.deep_slide: [30 %, 40 %]}\n", [], PASS),
        ("matrix: {rail.friction: [0.05, 0.1]}\n", ["controller=slip-band"], PASS),
        ("matrix: {rail.friction: [0.05, 0.1]}\n", ["expect=pass"], PASS),
    ],
)
def test_a_sweep_expects_of_its_cases_what_the_scenario_does_of_its_controller(
    load, text, overrides, expected
):
    plan = load(text, *overrides, stop=f"{STOP}expect: {{fail: [locked-wheels]}}\n")
    assert plan.base.scenario.expect == expected


def test_an_expectation_without_names_allows_the_controllers_of_a_sweep_nothing(load):
    plan = load("matrix: {controller: [threshold, slip-band]}\n", stop=f"{STOP}expect: fail\n")
    assert plan.base.scenario.expect == PASS
