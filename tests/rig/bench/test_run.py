"""The bench: the same parts as in a stop, without vehicle and controller."""

from dataclasses import replace

import numpy as np
import pytest

from uictest.core.physics.air import FILL, HOLD, VENT
from uictest.rig.bench.inputs import (
    BenchInput,
    bench_input,
    clock_of,
    joined_inputs,
    stepwise_input,
    triangular_input,
)
from uictest.rig.bench.recipe import load_bench, recipe_path
from uictest.rig.bench.run import BENCH_CHANNELS, run_bench, run_bench_test
from uictest.rig.simulation import simulate

from ..plain_numbers import on_numbers


@pytest.fixture(scope="module")
def case():
    return load_bench(recipe_path("stepwise")).case


@pytest.fixture(scope="module")
def clock(case):
    return clock_of(case)


@pytest.fixture(scope="module")
def pulled(case, clock):
    """Three bar, then vent for a second, hold and fill again."""
    full = stepwise_input([3e5], 3.0, clock)
    commands = np.repeat([VENT, HOLD, FILL], [100, 50, 150])
    cycle = BenchInput(np.full(300 * clock.steps_per_cycle, 3e5), commands)
    return run_bench(case, joined_inputs([full, cycle]))


def run_on_numbers(rig, demanded_pressures, valve_commands, trace):
    """Run the bench in plain Python."""
    inputs = demanded_pressures.tolist(), valve_commands.tolist()
    on_numbers(run_bench_test, rig, *inputs, trace, trace=trace)


def test_plain_and_compiled_bench_give_the_same_bits(case, clock):
    applied = triangular_input([1.5e5], 0.0, 1.5e6, clock)
    plain, compiled = run_bench(case, applied, run_on_numbers), run_bench(case, applied)
    assert compiled["clamping_force_1"][-1] < 0.9 * compiled["clamping_force_1"].max()
    for name, _ in BENCH_CHANNELS:
        assert np.array_equal(plain[name], compiled[name]), name


def test_the_record_has_every_channel_at_every_step(case, clock, pulled):
    assert tuple(pulled.units.items()) == BENCH_CHANNELS
    assert len(pulled) == 600 * clock.steps_per_cycle + 1
    assert np.diff(pulled["time"]) == pytest.approx(clock.step)


def test_the_loadcells_share_the_clamping_force_and_do_not_err_together(pulled):
    cells = sum(pulled[f"loadcell_{k}"] for k in (1, 2, 3))
    assert cells == pytest.approx(pulled["clamping_force_1"])
    largest = pulled["caliper_force_1"].max()
    assert np.abs(cells - pulled["caliper_force_1"]).max() < 0.02 * largest
    at = np.flatnonzero(pulled["clamping_force_1"] > 3000.0)[::20]
    errors = [pulled[f"loadcell_{k}"][at] / pulled["caliper_force_1"][at] for k in (1, 2, 3)]
    assert abs(np.corrcoef(np.diff(errors[0]), np.diff(errors[1]))[0, 1]) < 0.3


def test_the_line_follows_the_demand_and_the_air_of_the_tanks_the_valves(pulled):
    time = pulled["time"]
    assert pulled["brake_line_pressure"][np.searchsorted(time, 2.9)] == pytest.approx(3e5, rel=0.01)
    vented = pulled["tank_pressure_2"][np.searchsorted(time, 4.2)]
    assert vented < 0.9 * pulled["tank_pressure_2"][np.searchsorted(time, 2.9)]
    held = pulled["tank_pressure_2"][np.searchsorted(time, 4.3) : np.searchsorted(time, 4.45)]
    assert np.all(np.diff(held) > 0.0)
    assert np.ptp(held) < 5e3
    # Its balls keep the air warm, and its piston gives back what it had taken.
    at = np.searchsorted(time, 3.6)
    assert pulled["tank_pressure_1"][at] > pulled["tank_pressure_2"][at]


def test_the_settings_differ_as_their_names_say_and_the_modelled_air_is_nearer_to_module_1(pulled):
    """Without hysteresis force goes with pressure; with it, force stays while the pressure turns."""
    time = pulled["time"]
    turn = slice(np.searchsorted(time, 3.0), np.searchsorted(time, 3.2))
    names = ("none", "hysteresis", "cylinder", "full", "thermal")
    force = {name: pulled[f"computed_force_{name}_2"] for name in names}
    assert np.ptp(force["hysteresis"][turn]) < np.ptp(force["none"][turn])
    assert not np.array_equal(force["none"], force["cylinder"])
    assert not np.array_equal(force["hysteresis"], force["full"])
    assert not np.array_equal(force["hysteresis"], force["thermal"])
    at = pulled["time"] > 1.0

    def largest_error(name):
        return np.abs(pulled[name] - pulled["cylinder_pressure_1"])[at].max()

    assert largest_error("cylinder_pressure_thermal_2") < 0.5 * largest_error("measured_pressure_2")


def test_a_recorded_stop_repeats_its_commands_and_pressures(tmp_path):
    """On the bench, module 1 follows the pressure of module 1 in the stop that gave the commands."""
    recipe = tmp_path / "one.yaml"
    recipe.write_text(
        "schema: uictest/bench/1\nname: one\nstop:\n  initial_speed: 30 km/h\n  rail: {condition: wet}\n"
        "inputs:\n  - {kind: stop, friction: 0.08, wheelset: 1, seed: 3}\n",
        "utf-8",
    )
    test = load_bench(recipe)
    rail = test.case.scenario.rail.model_copy(update={"friction": test.recipe.inputs[0].friction})
    scenario = test.case.scenario.model_copy(update={"rail": rail, "seed": 3})
    stop = simulate(replace(test.case, scenario=scenario), 0.01).recording
    bench_record = run_bench(test.case, bench_input(test))
    same = bench_record["tank_pressure_1"][:: clock_of(test.case).steps_per_cycle]
    assert np.array_equal(bench_record["valve_command_1"][20::20], stop["valve_command_1"][1:])
    # Two modules draw from the line instead of four, so that it sags a little less.
    assert np.abs(same - stop["tank_pressure_1"]).max() < 0.04 * stop["tank_pressure_1"].max()
