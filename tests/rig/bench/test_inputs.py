"""Inputs of a bench test."""

import numpy as np
import pytest

from uictest.core.physics.air import FILL, HOLD, VENT
from uictest.plans.scenario import ScenarioErrors
from uictest.plans.scenario.yaml.model import quantities_in
from uictest.rig.bench.inputs import (
    Clock,
    bypassed_input,
    joined_inputs,
    random_input,
    recorded_input,
    stepwise_input,
    triangular_input,
    wsp_cycling_input,
)
from uictest.rig.bench.recipe import load_bench, recipe_names, recipe_path

CLOCK = Clock(0.0005, 20)


def test_steps_are_demanded_at_once_triangles_at_their_rate_and_inputs_one_after_the_other():
    applied = stepwise_input([1e5, 3e5], 0.5, CLOCK)
    assert applied.demanded_pressures[[0, 999, 1000, 1999]].tolist() == [1e5, 1e5, 3e5, 3e5]
    assert applied.valve_commands.tolist() == [FILL] * 100
    applied = triangular_input([2e5], 0.5e5, 1e5, CLOCK)
    assert len(applied.demanded_pressures) == 6000
    assert applied.demanded_pressures.max() == pytest.approx(2e5)
    assert np.abs(np.diff(applied.demanded_pressures)) == pytest.approx(50.0)
    parts = [stepwise_input([1e5], 0.1, CLOCK), stepwise_input([2e5], 0.2, CLOCK)]
    whole = joined_inputs(parts)
    assert len(whole.valve_commands) == 30
    assert whole.demanded_pressures[[0, -1]].tolist() == [1e5, 2e5]


def test_random_pressure_depends_on_its_seed_alone():
    first, again, other = (
        random_input(0.0, 4e5, 1.0, 5.0, seed, CLOCK).demanded_pressures for seed in (1, 1, 2)
    )
    assert np.array_equal(first, again)
    assert not np.array_equal(first, other)
    assert 0.0 <= first.min() <= first.max() <= 4e5


def test_wsp_cycling_vents_holds_and_fills_within_its_spans():
    applied = wsp_cycling_input(4e5, 1.0, 5, (0.1, 0.2), (0.05, 0.1), (0.1, 0.3), 7, CLOCK)
    commands = applied.valve_commands
    assert commands[:100].tolist() == [FILL] * 100
    changes = np.flatnonzero(np.diff(commands)) + 1
    order = commands[changes][:8].tolist()
    assert order == [VENT, HOLD, FILL, HOLD] * 2
    vents = [len(part) for part in np.split(commands, changes) if part[0] == VENT]
    assert len(vents) == 5
    assert all(10 <= length <= 20 for length in vents)
    assert len(applied.demanded_pressures) == 20 * len(commands)


def test_a_recorded_command_was_in_force_since_the_sample_before_and_without_one_the_valves_fill():
    time = np.array([0.0, 0.01, 0.02, 0.03]) + 5.0
    applied = recorded_input(time, np.full(4, 3e5), np.array([0.0, 0.0, 2.0, 1.0]), CLOCK)
    assert applied.valve_commands.tolist() == [FILL, VENT, HOLD]
    applied = recorded_input(np.array([0.0, 1.0]), np.array([0.0, 1e5]), None, CLOCK)
    assert set(applied.valve_commands.tolist()) == {FILL}
    assert applied.demanded_pressures[-1] == pytest.approx(1e5)
    bypassed = bypassed_input([0.0, 1.0], [0.0, 1e5], CLOCK)
    assert np.array_equal(applied.demanded_pressures, bypassed.demanded_pressures)


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
