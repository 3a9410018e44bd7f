"""Errors of every setting; and that training, calibration and judgement share no condition."""

from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
import yaml

from studies.model_errors import (
    JudgedConditions,
    force_channel,
    force_error,
    judged_cases,
    judged_conditions,
    pressure_error,
)
from studies.stop_runner import StopRunner
from uictest.core.recording import Recording
from uictest.plans.scenario import load
from uictest.rig import bench
from uictest.rig.bench.recipe import StopReplay

PRESSURES = (
    "cylinder_pressure_1",
    "measured_pressure_2",
    "cylinder_pressure_2",
    "cylinder_pressure_thermal_2",
)
FORCES = ("clamping_force_1", "computed_force_full_2")
UNITS = {"time": "s", **dict.fromkeys(PRESSURES, "Pa"), **dict.fromkeys(FORCES, "N")}


@pytest.fixture
def recording():
    samples = ([0, 1, 2], [0, 3e5, 3e5], [0, 2.8e5, 3.1e5], [0, 3e5, 3.04e5], [0, 3e5, 2.98e5])
    forces = ([0, 8e3, 10e3], [0, 8.2e3, 9.5e3])
    channels = [np.array(each, dtype=float) for each in (*samples, *forces)]
    return Recording(dict(zip(UNITS, channels, strict=True)), UNITS)


@pytest.mark.parametrize(
    ("setting", "error"),
    [("none", 5.0), ("hysteresis", 5.0), ("cylinder", 1.0), ("full", 1.0), ("thermal", 0.5)],
)
def test_each_setting_is_judged_by_the_pressure_that_it_uses(recording, setting, error):
    assert pressure_error(recording, setting, 4e5) == pytest.approx(error)


def test_the_true_pressure_may_be_compared_and_a_force_error_is_a_share_of_the_largest_force(recording):
    true = Recording(
        {**recording.channels, "tank_pressure_1": recording["cylinder_pressure_1"] + 2e3},
        {**UNITS, "tank_pressure_1": "Pa"},
    )
    assert pressure_error(true, "thermal", 4e5, "tank_pressure_1") == pytest.approx(1.0)
    assert force_error(recording, force_channel("full")) == pytest.approx(5.0)


CALIBRATION = Path(__file__).parents[2] / "calibration" / "conditions.yaml"


def trained(key):
    """Frictions or seeds of the stops on which the compensation is trained."""
    recipes = [bench.load_bench(bench.recipe_path(name)).recipe for name in bench.recipe_names()]
    stops = [each for recipe in recipes for each in recipe.inputs if isinstance(each, StopReplay)]
    return {getattr(stop, key) for stop in stops}


@pytest.mark.parametrize(("key", "trained_key"), [("frictions", "friction"), ("seeds", "seed")])
def test_training_calibration_and_judgement_are_disjoint(key, trained_key):
    calibrated = set(yaml.safe_load(CALIBRATION.read_text("utf-8"))[key])
    judged = set(getattr(judged_conditions(), key))
    conditions = (trained(trained_key), calibrated, judged)
    assert all(conditions)
    assert all(one.isdisjoint(other) for one, other in combinations(conditions, 2))


def test_the_calibration_names_the_frictions_of_its_scenarios():
    scenarios = CALIBRATION.parents[1] / "scenarios"
    named = yaml.safe_load(CALIBRATION.read_text("utf-8"))["frictions"]
    cases = load([scenarios / f"{name}.yaml" for name in ("slide-80", "slip-120", "low-adhesion-80")])
    assert set(named) == {case.scenario.rail.friction for case in cases}


def test_every_wheelset_is_judged_in_more_than_one_position():
    conditions = judged_conditions()
    assert conditions.wheelsets == [1, 2, 3, 4]
    assert len(conditions.positions) > 1


def test_every_combination_is_a_stop_with_four_calipers():
    conditions = JudgedConditions(frictions=(0.08, 0.1), positions=("P", "R"), wheelsets=(1,), seeds=(31, 32))
    scenarios = [case.scenario for case in judged_cases(StopRunner(), conditions)]
    assert {(each.rail.friction, each.brake.position, each.seed) for each in scenarios} == {
        (friction, position, seed) for friction in (0.08, 0.1) for position in "PR" for seed in (31, 32)
    }
    assert {each.rig.topology for each in scenarios} == {"four-caliper"}
