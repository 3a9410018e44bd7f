"""Every shipped case, simulated."""

import math
from pathlib import Path

import numpy as np
import pytest

from uictest.plans.scenario import load
from uictest.rig import assemble, noise_key, noise_key_text, simulate


@pytest.fixture(name="stops", scope="module")
def _stops(scenarios):
    return {case.id: simulate(case) for case in scenarios}


def test_every_case_comes_to_a_standstill_and_conserves_energy_and_air(stops):
    """None is recorded unless it is asked to."""
    limits = {"energy_residual": 1e-3, "air_residual": 1e-9, "air_energy_residual": 1e-9}
    for residual, limit in limits.items():
        residuals = {name: float(stop.measures[residual]) for name, stop in stops.items()}
        assert {name: value for name, value in residuals.items() if abs(value) >= limit} == {}, residual
    assert {name for name, stop in stops.items() if stop.measures.stopped != 1.0} == set()
    assert all(stop.recording is None for stop in stops.values())


def test_trailing_wheelsets_slide_first(stops):
    """In the slide tests, where the rail is the same under all of them."""
    slide_tests = [name for name in stops if name.startswith("slide-80")]
    assert len(slide_tests) >= 5
    assert all(stops[name].measures.sliding_wheelset in (2.0, 4.0) for name in slide_tests)


def test_shipped_cases_show_what_they_are_for(stops):
    bypassed = stops["wsp-bypassed-80"].wheelset_measures
    assert np.all(bypassed.locked_time > 10.0)
    assert not bypassed.valve_actuations.any()
    dry = stops["dry-120"].measures
    assert np.isnan(dry.sliding_time)
    assert 0.9 < dry.minimum_deceleration < dry.maximum_deceleration < 1.5
    # Without compensation modules of the one-caliper rig actuate more often than those of four calipers.
    none = stops["slide-80[compensation=none]"].wheelset_measures.valve_actuations[1:].sum()
    four = stops["slide-80-four-caliper"].wheelset_measures.valve_actuations[1:].sum()
    assert none > 1.2 * four


def test_recording_has_every_channel_of_train_and_wheelsets(scenarios):
    recording = simulate(scenarios[0], record_every=0.05).recording
    time = recording.channels["time"]
    np.testing.assert_allclose(np.diff(time), 0.05, rtol=1e-9)
    assert recording.units["clamping_force_4"] == "N"
    assert all(column.shape == time.shape for column in recording.channels.values())


def test_diagnosis_is_recorded_only_of_a_controller_from_outside(rig, tmp_path):
    """All 32 bits of it; a reference speed that the controller does not give is NaN."""
    (tmp_path / "wsp.py").write_text(
        "from uictest.controllers import Outputs\n"
        "class Wsp:\n"
        "    def __init__(self, config): pass\n"
        "    def reset(self): pass\n"
        "    def step(self, inputs):\n"
        "        return Outputs([0] * 4, [0] * 4, diagnosis=2**32 - 1 - inputs.cycle)\n"
    )
    scenario = tmp_path / "stop.yaml"
    scenario.write_text(
        "schema: uictest/scenario/1\nname: stop\ninitial_speed: 20 km/h\n"
        "controller: {python: wsp.py, class: Wsp}\n"
    )
    own, outside = (simulate(case, record_every=0.1).recording for case in (rig.case(), *load([scenario])))
    assert outside.channels.keys() - own.channels.keys() == {"diagnosis"}
    cycles = np.maximum(np.rint(outside["time"] / 0.01) - 1, 0)
    np.testing.assert_array_equal(outside["diagnosis"], 2**32 - 1 - cycles)
    assert np.isnan(outside["reference_speed"]).all()


def test_temperatures_are_recorded_only_where_they_are_modelled(rig):
    """A recording has no channel that means nothing; its units are SI."""
    cold, warm = (
        simulate(rig.case(f"brake.disc_temperature={setting}"), record_every=0.1).recording
        for setting in ("constant", "modelled")
    )
    added = {f"{name}_{n}" for name in ("disc_temperature", "disc_surface_temperature") for n in (1, 2, 3, 4)}
    assert set(warm.channels) - set(cold.channels) == added
    assert {warm.units[name] for name in added} == {"K"}
    assert (warm["disc_surface_temperature_2"][0], cold["pad_friction_1"][-1]) == (293.15, 0.38)


LOST = "{at: 0.5 s, until: 1 s, wheelset: 2, part: speed-sensor, kind: lost}"
LEAK = "{at: 0.8 s, part: brake-line, kind: leak, value: 1e-8 m3/(s Pa)}"
SHORT = ("initial_speed=12 km/h",)


def test_bits_say_which_faults_are_active(rig):
    recording = simulate(rig.case(*SHORT, f"faults=[{LOST}, {LEAK}]"), 0.01).recording
    time, bits = recording["time"], recording["active_faults"]
    # A sample at the end of a cycle shows what held in it.
    cycles = np.ceil(time / 0.01 - 1e-6) - 1
    expected = 1 * ((cycles >= 50) & (cycles < 100)) + 2 * (cycles >= 80)
    np.testing.assert_array_equal(bits[1:], expected[1:])
    np.testing.assert_array_equal(recording["speed_valid_2"][1:], np.where(expected[1:] % 2, 0.0, 1.0))
    assert recording.metadata["faults"] == "speed-sensor-lost-2, brake-line-leak"
    sound = simulate(rig.case(*SHORT), 0.01).recording
    assert not {"active_faults", "speed_valid_1"} & set(sound.channels)
    assert "faults" not in sound.metadata


SCENARIOS = Path(__file__).parents[2] / "scenarios"


def key(rig, *overrides):
    return int(assemble(rig.case(*overrides)).parameters.noise_key)


UNDER_TEST = [
    ("title=Another title",),
    ("controller=slip-band",),
    ("controller.slip_threshold=1.5 m/s",),
    ("rig.topology=one-caliper",),
    ("rig.compensation=none",),
    ("rig.wsp=bypassed",),
    ("measures.moving_speed=3 km/h",),
    ("simulation.time_step=0.25 ms",),
    ("simulation.maximum_duration=200 s",),
    ("criteria=uictest-stop",),
    ("seed=7",),
    ("brake.command=100 %",),
]
CONDITIONS = [
    ("initial_speed=81 km/h",),
    ("brake.command=90 %",),
    ("brake.position=P",),
    ("rail.friction=0.101",),
    ("rail.friction_over_time={points: [{time: 0 s, factor: 1}, {time: 5 s, factor: 0.9}]}",),
    ("vehicle=crh380a",),
    ("vehicle.wheelsets={2: {wheel_radius: 0.425 m}}",),
    ("vehicle.wheelsets={3: {brake_force: 97 %}}",),
    ("vehicle.wheelsets={3: {pad_friction: 0.36}}",),
]


def test_what_is_under_test_meets_the_same_noise_and_other_conditions_draw_another(rig):
    own = key(rig)
    assert {overrides: key(rig, *overrides) for overrides in UNDER_TEST} == dict.fromkeys(UNDER_TEST, own)
    keys = [own, *(key(rig, *overrides) for overrides in CONDITIONS)]
    assert len(set(keys)) == len(keys)


def test_points_that_fill_up_a_friction_law_do_not_count(rig):
    stop = assemble(rig.case())
    longer = np.pad(stop.rail, ((0, 0), (0, 5)), constant_values=9.0)
    assert noise_key(stop.parameters, stop.wheelset_parameters, longer) == stop.parameters["noise_key"]


def test_an_axis_of_one_value_more_changes_no_digit_of_a_stop(rig):
    path = rig.case().path
    (alone,) = load([path], ["rail.friction=0.1", "initial_speed=20 km/h"])
    first, _ = load([path], ["rail.friction=0.1,0.11", "initial_speed=20 km/h"])
    assert first.id != alone.id
    assert simulate(first).measures.tobytes() == simulate(alone).measures.tobytes()


C_FUNCTIONS = ("exp", "expm1", "log", "log1p", "log10", "pow", "sin", "cos", "tan", "atan", "tanh", "hypot")
MOTORS = "brake.dynamic={force: 60 kN, power: 1.6 MW, wheelsets: [1, 4]}"


def one_bit_off(function):
    return lambda *numbers: math.nextafter(function(*numbers), math.inf)


KEYS = {
    "dry-120": "e7339369",
    "slip-120": "ef267742",
    "cleaned-rail-120": "096911f6",
    "friction-step-120": "4a62c534",
    "radius-80[configured_radius=0.4214m]": "70a1f28b",
}
"""Of some shipped cases, on any machine: with another one all noise of a stop is another."""


@pytest.fixture(scope="module")
def shipped():
    """The shipped cases, and one whose motors take a function of the C library."""
    [motored] = load([SCENARIOS / "dry-120.yaml"], [MOTORS])
    return {case.id: case for case in load([SCENARIOS]) if case.train is None} | {"motors": motored}


def test_the_keys_of_shipped_cases(shipped):
    assert {name: noise_key_text(assemble(shipped[name]).parameters) for name in KEYS} == KEYS


def test_no_key_depends_on_the_last_bit_of_a_function_of_the_c_library(shipped, monkeypatch):
    """The values behind a key are read exactly, added, multiplied and divided: IEEE 754 defines the bits."""
    before = {name: assemble(case).parameters for name, case in shipped.items()}
    for function in C_FUNCTIONS:
        monkeypatch.setattr(math, function, one_bit_off(getattr(math, function)))
    after = {name: assemble(case).parameters for name, case in shipped.items()}
    assert [after[name].noise_key for name in shipped] == [before[name].noise_key for name in shipped]
    assert after["motors"].motor_response != before["motors"].motor_response
