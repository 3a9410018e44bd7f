"""Bench recipes."""

import pytest

from uictest.plans.scenario import ScenarioErrors
from uictest.plans.scenario.yaml.model import quantities_in
from uictest.rig.bench.recipe import load_bench, recipe_names, recipe_path


@pytest.mark.parametrize("name", recipe_names())
def test_every_recipe_of_the_library_is_valid_and_marks_its_numbers(name):
    recipe = load_bench(recipe_path(name)).recipe
    assert recipe.name == name
    assert all(quantity.source in recipe.sources for _, quantity in quantities_in(recipe))


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("inputs: []", "inputs"),
        ("inputs:\n  - {kind: sinus}", "unknown kind 'sinus'"),
        ("inputs:\n  - {kind: rest, duration: 4}", "has no unit"),
        ("inputs:\n  - {kind: rest}", "missing key 'duration'"),
        ("stop: {name: x}\ninputs:\n  - {kind: rest, duration: 1 s}", "does not belong here"),
        ("stop: {brake: {position: X}}\ninputs:\n  - {kind: rest, duration: 1 s}", "unknown brake position"),
        ("inputs:\n  - {kind: stop, friction: 0.1, wheelset: 5, seed: 1}", "wheelset"),
    ],
)
def test_a_wrong_recipe_is_refused_at_its_place(tmp_path, text, told):
    path = tmp_path / "wrong.yaml"
    path.write_text(f"schema: uictest/bench/1\nname: wrong\n{text}\n", "utf-8")
    with pytest.raises(ScenarioErrors) as caught:
        load_bench(path)
    assert told in str(caught.value)


def test_overrides_reach_the_rig_and_lists_are_refused():
    test = load_bench(recipe_path("stepwise"), ["rig.caliper.load_friction=7 %"], seed=5)
    assert test.case.scenario.rig.caliper.load_friction == pytest.approx(0.07)
    assert test.case.scenario.seed == 5
    with pytest.raises(ScenarioErrors, match="one run"):
        load_bench(recipe_path("stepwise"), ["rig.caliper.load_friction=6 %,7 %"])
