"""What decides the sensors' noise, and what must not."""

import math
from pathlib import Path

import numpy as np
import pytest

from uictest.rig import assemble, noise_key_text, noise_keys

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


@pytest.mark.parametrize("overrides", UNDER_TEST, ids=lambda each: each[0].split("=")[0])
def test_what_is_under_test_meets_the_same_noise(rig, overrides):
    assert key(rig, *overrides) == key(rig)


def test_stops_that_differ_in_their_conditions_draw_different_noise(rig):
    keys = [key(rig), *(key(rig, *overrides) for overrides in CONDITIONS)]
    assert len(set(keys)) == len(keys)


def test_points_that_fill_up_a_friction_law_do_not_count(rig):
    stop = assemble(rig.case())
    longer = np.pad(stop.rail, ((0, 0), (0, 5)), constant_values=9.0)
    records = np.array([stop.parameters]), stop.wheelset_parameters[None]
    assert noise_keys(*records, longer[None]) == noise_keys(*records, stop.rail[None])


def test_an_axis_of_one_value_more_changes_no_digit_of_a_stop(rig):
    from uictest.plans.scenario import load
    from uictest.rig import simulate

    path = rig.case().path
    (alone,) = load([path], ["rail.friction=0.1", "initial_speed=20 km/h"])
    first, _ = load([path], ["rail.friction=0.1,0.11", "initial_speed=20 km/h"])
    assert first.id != alone.id
    assert simulate(first).measures.tobytes() == simulate(alone).measures.tobytes()


def test_many_stops_have_the_keys_that_each_has_alone(rig):
    overrides = [(), *CONDITIONS, ("rail.friction={points: [{position: 0 m, friction: 0.1}]}",)]
    stops = [assemble(rig.case(*each)) for each in overrides]
    longest = max(stop.rail.shape[1] for stop in stops)
    rails = [np.pad(stop.rail, ((0, 0), (0, longest - stop.rail.shape[1]))) for stop in stops]
    records = np.array([stop.parameters for stop in stops])
    wheelsets = np.array([stop.wheelset_parameters for stop in stops])
    found = noise_keys(records, wheelsets, np.array(rails))
    assert found.tolist() == [int(stop.parameters.noise_key) for stop in stops]


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
    from uictest.plans.scenario import load

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
