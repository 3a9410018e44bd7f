"""The second module by itself: balances, limits of its laws, what its parts do, what it is judged on."""

import re
from hashlib import sha256
from pathlib import Path

import numpy as np
import pytest
import yaml

from studies.hardware import equations
from studies.hardware.bench import recorded
from studies.hardware.judged import BENCHES, INPUTS, conditions, only_inputs
from studies.hardware.module import run
from studies.hardware.parameters import (
    AMBIENT,
    ATMOSPHERE,
    BAR,
    GAS,
    HARDWARE,
    WITHOUT,
    hose_area,
    hose_volume,
    leak_conductance,
)
from studies.model_errors import judged_conditions
from uictest import Recording
from uictest.rig import bench

STEP = 5e-4
FILL, HOLD, VENT = 0, 1, 2
REPOSITORY = Path(__file__).parents[2]
FULL = 4.6 * BAR
FIXED = HARDWARE._replace(preload=2e4, stop_stiffness=1e9)
"""A piston that no pressure moves."""
ADIABATIC = dict.fromkeys(("hose_heat", "cylinder_heat", "ball_heat", "bare_heat"), 0.0)


def driven(duration, *commands, pressure=FULL):
    """Return line pressure, filled in 0.8 s, and commands that change at (time, command)."""
    time = np.arange(round(duration / STEP)) * STEP
    line = np.interp(time, [0.1, 0.9], [0.0, pressure])
    in_force = np.zeros(len(time))
    for start, command in commands:
        in_force[time >= start] = command
    return time, line, in_force


def at(found, channel, time):
    return found[channel][round(time / STEP)]


@pytest.fixture(scope="module")
def cycled():
    """Fill, vent, hold and fill again."""
    time, line, commands = driven(8.0, (3.0, VENT), (3.5, HOLD), (5.0, FILL))
    return time, run(line, commands, STEP, HARDWARE)


def test_the_air_of_the_module_is_what_entered_less_what_left(cycled):
    _, found = cycled
    balance = found["air"] - found["air"][0] - found["drawn"] + found["vented"] + found["leaked"]
    assert np.abs(balance).max() < 1e-12
    assert found["vented"][-1] > 1e-3 < found["drawn"][-1]


def test_shorter_steps_change_no_pressure_by_more_than_what_its_sensor_resolves_twice():
    _, line, commands = driven(6.0, (2.0, VENT), (2.4, HOLD), (3.0, FILL), (4.5, VENT))
    coarse, fine = (run(line, commands, STEP, HARDWARE, refine) for refine in (1, 8))
    for channel in ("tank_1", "cylinder", "tank_2"):
        assert np.abs(coarse[channel] - fine[channel]).max() < 2.0 * 10.0 * BAR / 2**12
    assert np.abs(coarse["force"] - fine["force"]).max() < 0.002 * fine["force"].max()


@pytest.mark.parametrize("exponent", [0.5, 0.57, 1.0])
def test_the_orifice_is_choked_below_its_ratio_and_still_at_equal_pressures(exponent):
    reduced = equations.reduced
    assert reduced(0.1, 0.24, exponent) == reduced(0.24, 0.24, exponent) == 1.0
    assert reduced(1.0, 0.24, exponent) == 0.0
    ratios = np.linspace(0.24, 1.0, 2000)
    flows = [reduced(ratio, 0.24, exponent) for ratio in ratios]
    assert np.all(np.diff(flows) < 0.0)
    assert reduced(0.999 + 1e-9, 0.24, exponent) == pytest.approx(reduced(0.999, 0.24, exponent), rel=1e-5)


def test_an_orifice_with_index_one_half_is_the_ellipse_of_the_old_standard_and_choked_sonic_both_ways():
    x = (0.7 - 0.24) / (1.0 - 0.24)
    assert equations.reduced(0.7, 0.24, 0.5) == pytest.approx((1.0 - x**2) ** 0.5)
    assert equations.reduced(0.7, 0.24, 0.57) < (1.0 - x**2) ** 0.5
    flow = equations.orifice(5e5, AMBIENT, 1e5, AMBIENT, 6e-8, 0.24, 0.57)
    assert flow == pytest.approx(6e-8 * 1.185 * 5e5)
    assert equations.orifice(1e5, AMBIENT, 5e5, AMBIENT, 6e-8, 0.24, 0.57) == pytest.approx(-flow)
    assert equations.orifice(5e5, 4.0 * AMBIENT, 1e5, AMBIENT, 6e-8, 0.24, 0.57) == pytest.approx(0.5 * flow)


def test_the_hose_is_laminar_at_first_and_blasius_where_it_is_quick():
    bore, length, pressure = 0.01, 2.0, 5e5
    density = pressure / (GAS * AMBIENT)
    slow = 0.01 * density * 0.25 * np.pi * bore**2
    hagen_poiseuille = 128.0 * 1.81e-5 * length * (slow / density) / (np.pi * bore**4)
    assert equations.hose_drop(slow, pressure, bore, length, 0.0) == pytest.approx(hagen_poiseuille)
    reynolds = density * 20.0 * bore / 1.81e-5
    blasius = 0.3164 / reynolds**0.25 * length / bore * 0.5 * density * 20.0**2
    quick = 20.0 / 0.01 * slow
    assert equations.hose_drop(quick, pressure, bore, length, 0.0) == pytest.approx(blasius, rel=1e-3)
    fitted = blasius + 4.0 * 0.5 * density * 20.0**2
    assert equations.hose_drop(-quick, pressure, bore, length, 4.0) == pytest.approx(-fitted, rel=1e-3)


def test_in_a_narrow_hose_the_cylinder_lags_by_its_resistance_times_the_volume_behind_it():
    """Laminar and slow: R dp/dt of the cylinder's air, n V / (R T) of it isothermal, is the drop."""
    narrow = FIXED._replace(hose_bore=0.001, hose_losses=0.0, cylinder_heat=10.0, leak_rate=0.0)
    time = np.arange(round(40.0 / STEP)) * STEP
    line = np.interp(time, [0.0, 40.0], [0.0, 2.0 * BAR])
    found = run(line, np.zeros(len(time)), STEP, narrow)
    pressure = at(found, "cylinder", 30.0)
    volume = narrow.dead_volume + 0.5 * hose_volume(narrow) + narrow.area * at(found, "stroke", 30.0)
    flow = volume / (GAS * AMBIENT) * np.gradient(found["cylinder"], STEP)[round(30.0 / STEP)]
    density = pressure / (GAS * AMBIENT)
    drop = 128.0 * 1.81e-5 * narrow.hose_length * flow / density / (np.pi * 0.001**4)
    assert at(found, "tank_1", 30.0) - pressure == pytest.approx(drop, rel=0.03)
    assert drop > 50.0


def test_the_hose_rings_with_the_inertia_of_its_air():
    """Helmholtz: between two vessels, omega2 = k p A / L (1 / (rho V1) + 1 / (rho V2))."""
    adiabatic = FIXED._replace(hose_losses=0.0, **ADIABATIC)
    _, line, commands = driven(4.0, (3.0, VENT), (3.02, HOLD))
    found = run(line, commands, STEP, adiabatic)
    difference = (found["tank_1"] - found["cylinder"])[round(3.07 / STEP) : round(3.3 / STEP)]
    crossings = np.flatnonzero(np.diff(np.sign(difference - difference.mean())))
    period = 2.0 * np.diff(crossings).mean() * STEP
    half = 0.5 * hose_volume(HARDWARE)
    volumes = HARDWARE.tank_volume - HARDWARE.ball_volume + half, HARDWARE.dead_volume + half
    sound = 1.4 * at(found, "cylinder", 3.1) * sum(volumes) / at(found, "air", 3.1)
    omega = np.sqrt(sound * hose_area(HARDWARE) / HARDWARE.hose_length * sum(1.0 / each for each in volumes))
    assert period == pytest.approx(2.0 * np.pi / omega, rel=0.05)


def test_a_wide_hose_gives_the_pressures_of_one_vessel():
    """Filled without heat, the piston at rest: the energy of the air is p V / (k - 1), however mixed."""
    _, line, commands = driven(3.0)
    short = FIXED._replace(hose_length=0.05, hose_bore=0.02, hose_losses=0.0, **ADIABATIC)
    # The hose that is taken away leaves its volume.
    merged = FIXED._replace(hose_bore=0.0, hose_length=0.2, **ADIABATIC)
    joined, one = run(line, commands, STEP, short), run(line, commands, STEP, merged)
    assert np.abs(joined["cylinder"] - one["cylinder"]).max() < 0.005 * BAR


def test_the_leak_empties_the_shut_module_at_its_rate_and_exponentially_at_low_pressure():
    _, line, commands = driven(40.0, (10.0, HOLD), pressure=3.8 * BAR)
    found = run(line, commands, STEP, FIXED)
    fall = (at(found, "cylinder", 15.0) - at(found, "cylinder", 25.0)) / 10.0
    shut = HARDWARE.area * HARDWARE.clearance
    volume = HARDWARE.tank_volume - HARDWARE.ball_volume + hose_volume(HARDWARE) + HARDWARE.dead_volume
    assert fall == pytest.approx(HARDWARE.leak_rate * (volume + shut) / volume, rel=0.03)
    quick = FIXED._replace(leak_rate=200.0 * HARDWARE.leak_rate)
    _, line, commands = driven(20.0, (3.0, HOLD), pressure=0.05 * BAR)
    found = run(line, commands, STEP, quick)
    gauge = found["cylinder"][round(4.0 / STEP) :: round(2.0 / STEP)] - ATMOSPHERE
    rate = 2.0 * ATMOSPHERE * leak_conductance(quick) * GAS * AMBIENT / volume
    assert -np.diff(np.log(gauge)) / 2.0 == pytest.approx(rate, rel=0.03)


def test_no_force_before_contact_then_travel_that_grows_with_force(cycled):
    _, found = cycled
    closed = found["stroke"] > HARDWARE.clearance
    assert not np.any(found["force"][~closed])
    compression = found["stroke"] - HARDWARE.clearance
    full = compression.max()
    elastic = HARDWARE.lever_ratio * (HARDWARE.stiffness + HARDWARE.stiffening * full) * full
    assert found["force"].max() == pytest.approx(elastic, rel=1e-3)
    assert 1.5e-3 < full < 2e-3


def test_force_over_pressure_is_a_closed_loop_about_half_a_bar_wide():
    time = np.arange(round(70.0 / STEP)) * STEP
    line = np.interp(time, [0, 10, 20, 30, 40, 50, 60], np.array([0, 4.5, 1, 4.5, 1, 4.5, 1]) * BAR)
    found = run(line, np.zeros(len(time)), STEP, HARDWARE)
    force, gauge = found["force"], found["cylinder"] - ATMOSPHERE
    second, third = slice(round(30 / STEP), round(50 / STEP)), slice(round(50 / STEP), round(70 / STEP))
    assert np.abs(force[second.start] - force[third.start]) < 0.002 * force.max()
    rising = slice(round(41 / STEP), round(49 / STEP))
    up = np.interp(12e3, force[rising], gauge[rising])
    falling = slice(round(51 / STEP), round(59 / STEP))
    down = np.interp(12e3, force[falling][::-1], gauge[falling][::-1])
    load = 12e3 / HARDWARE.lever_ratio
    width = 2.0 * (HARDWARE.coulomb + HARDWARE.load_friction * load) / HARDWARE.area
    assert up - down == pytest.approx(width, rel=0.05)


def test_what_is_taken_away_is_away():
    _, line, commands = driven(6.0, (2.0, VENT), (2.4, HOLD))
    whole = run(line, commands, STEP, HARDWARE)
    less = {name: run(line, commands, STEP, HARDWARE._replace(**each)) for name, each in WITHOUT.items()}
    assert np.array_equal(less["hose"]["tank_1"], less["hose"]["cylinder"])
    assert less["leak"]["leaked"][-1] == 0.0 < whole["leaked"][-1]
    assert less["travel"]["stroke"].max() < HARDWARE.clearance + 2e-4 < whole["stroke"].max()
    assert np.abs(less["orifice"]["tank_2"] - whole["tank_2"]).max() > 0.05 * BAR


def test_the_bench_reads_within_the_errors_of_its_sensors_and_repeats_by_seed():
    time, line, commands = driven(3.0)
    units = dict(zip(INPUTS, ("s", "Pa", "1"), strict=True))
    inputs = Recording(dict(zip(INPUTS, (time, line, commands), strict=True)), units, {})
    first, again, other = (recorded(inputs, seed) for seed in (1, 1, 2))
    assert np.array_equal(first["cylinder_pressure_1"], again["cylinder_pressure_1"])
    assert not np.array_equal(first["cylinder_pressure_1"], other["cylinder_pressure_1"])
    error = first["cylinder_pressure_1"] - first["tank_pressure_1"]
    assert 0.001 * BAR < np.abs(error).max() < 0.02 * BAR


def test_the_module_sees_of_a_record_only_what_drives_it():
    channels = {name: np.arange(3.0) for name in (*INPUTS, "cylinder_pressure_1", "clamping_force_1")}
    kept = only_inputs(Recording(channels, {**dict.fromkeys(channels, "Pa"), "time": "s"}, {}))
    assert tuple(kept.channels) == INPUTS


def test_judged_stops_share_no_condition_with_training_calibration_or_the_other_judgement():
    judged = conditions()
    stops = len(judged.frictions) * len(judged.speeds) * len(judged.commands) * len(judged.controllers)
    assert stops >= 48
    recipes = [bench.load_bench(bench.recipe_path(name)) for name in BENCHES.values()]
    replays = [each for test in recipes for each in test.recipe.inputs if each.kind == "stop"]
    calibration = yaml.safe_load((REPOSITORY / "calibration" / "conditions.yaml").read_text("utf-8"))
    other = judged_conditions()
    used = {float(each.friction) for each in replays} | set(calibration["frictions"]) | set(other.frictions)
    assert not used & set(judged.frictions)
    assert judged.seed not in {each.seed for each in replays} | set(calibration["seeds"]) | set(other.seeds)
    assert judged.wheelset not in {each.wheelset for each in replays}
    trained = {test.case.scenario.initial_speed.text for test in recipes}
    assert not trained & set(judged.speeds)


def test_module_and_judged_stops_are_those_that_were_declared_before_the_first_identification():
    """Digests as declared. What was judged by them says nothing of others: declare those anew."""
    conditions = REPOSITORY / "studies" / "conditions"
    texts = [
        repr((HARDWARE, WITHOUT)).encode(),
        *(conditions.joinpath(f"{name}another-caliper.yaml").read_bytes() for name in ("", "brake-of-")),
    ]
    declared = ["b056a4471de7ae46", "aae800d9e20a6db2", "88bd524f92711afe"]
    assert [sha256(text).hexdigest()[:16] for text in texts] == declared


def test_the_module_is_written_without_the_rig():
    for path in (REPOSITORY / "studies" / "hardware").glob("*.py"):
        if path.name not in ("judged.py", "bench.py", "compiled.py"):
            code = re.sub(r'""".*?"""', "", path.read_text("utf-8"), flags=re.DOTALL)
            assert not re.search(r"\buictest\b", code)
