"""Training, calibration and judgement share no condition."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path
from typing import Any

import pytest
import yaml

from studies import judged_conditions as module
from studies.judged_conditions import JudgedConditions, judged_cases, judged_conditions
from studies.stop_runner import StopRunner
from uictest.plans.scenario import load
from uictest.rig import bench
from uictest.rig.bench.recipe import StopReplay

CALIBRATION = Path(__file__).parents[2] / "calibration" / "conditions.yaml"


def trained(key: str) -> set[Any]:
    """Frictions or seeds of the stops on which the compensation is trained."""
    recipes = [bench.load_bench(bench.recipe_path(name)).recipe for name in bench.recipe_names()]
    stops = [each for recipe in recipes for each in recipe.inputs if isinstance(each, StopReplay)]
    return {getattr(stop, key) for stop in stops}


@pytest.mark.parametrize(("key", "trained_key"), [("frictions", "friction"), ("seeds", "seed")])
def test_training_calibration_and_judgement_are_disjoint(key: str, trained_key: str) -> None:
    calibrated = set(yaml.safe_load(CALIBRATION.read_text("utf-8"))[key])
    judged = set(getattr(judged_conditions(), key))
    conditions = (trained(trained_key), calibrated, judged)
    assert all(conditions)
    assert all(one.isdisjoint(other) for one, other in combinations(conditions, 2))


def test_the_calibration_names_the_frictions_of_its_scenarios() -> None:
    scenarios = CALIBRATION.parents[1] / "scenarios"
    named = yaml.safe_load(CALIBRATION.read_text("utf-8"))["frictions"]
    cases = load([scenarios / f"{name}.yaml" for name in ("slide-80", "slip-120", "low-adhesion-80")])
    assert set(named) == {case.scenario.rail.friction for case in cases}


def test_every_wheelset_is_judged_in_more_than_one_position() -> None:
    conditions = judged_conditions()
    assert conditions.wheelsets == (1, 2, 3, 4)
    assert len(conditions.positions) > 1


def test_every_combination_is_a_stop_with_four_calipers() -> None:
    conditions = JudgedConditions(frictions=(0.08, 0.1), positions=("P", "R"), wheelsets=(1,), seeds=(31, 32))
    scenarios = [case.scenario for case in judged_cases(StopRunner(), conditions)]
    assert {(each.rail.friction, each.brake.position, each.seed) for each in scenarios} == {
        (friction, position, seed) for friction in (0.08, 0.1) for position in "PR" for seed in (31, 32)
    }
    assert {each.rig.topology for each in scenarios} == {"four-caliper"}


def test_an_error_in_the_file_names_its_place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "judgement.yaml"
    path.write_text("frictions: [0.08]\npositions: [R]\nwheelsets: [5]\nseeds: [31]\n")
    monkeypatch.setattr(module, "_FILE", path)
    with pytest.raises(ValueError, match=r"wheelsets.0\n.*less than or equal to 4"):
        judged_conditions()
