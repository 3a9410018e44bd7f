"""Every shipped case, simulated."""

import numpy as np
import pytest

from uictest.plans.scenario import load
from uictest.rig import simulate


@pytest.fixture(name="stops", scope="module")
def _stops(scenarios):
    return {case.id: simulate(case) for case in scenarios}


@pytest.mark.parametrize(
    ("residual", "limit"), [("energy_residual", 1e-3), ("air_residual", 1e-9), ("air_energy_residual", 1e-9)]
)
def test_energy_and_air_are_conserved_in_every_case(stops, residual, limit):
    residuals = {name: float(stop.measures[residual]) for name, stop in stops.items()}
    assert {name: each for name, each in residuals.items() if abs(each) >= limit} == {}


def test_every_case_comes_to_a_standstill(stops):
    assert {name for name, s in stops.items() if s.measures.stopped != 1.0} == set()


def test_trailing_wheelsets_slide_first(stops):
    """In the slide tests, where the rail is the same under all of them."""
    slide_tests = [name for name in stops if name.startswith("slide-80")]
    assert len(slide_tests) >= 5
    assert all(stops[name].measures.sliding_wheelset in (2.0, 4.0) for name in slide_tests)


def test_wheels_lock_without_protection(stops):
    bypassed = stops["wsp-bypassed-80"].wheelset_measures
    assert np.all(bypassed.locked_time > 10.0)
    assert not bypassed.valve_actuations.any()


def test_dry_rail_lets_nothing_slide(stops):
    dry = stops["dry-120"]
    assert np.isnan(dry.measures.sliding_time)
    assert dry.measures.minimum_deceleration > 0.9
    assert dry.measures.maximum_deceleration < 1.5


def test_compensation_settles_the_valves(stops):
    """Without it the modules of the one-caliper rig actuate more often than those of four calipers."""
    none = stops["slide-80[compensation=none]"].wheelset_measures.valve_actuations[1:].sum()
    four = stops["slide-80-four-caliper"].wheelset_measures.valve_actuations[1:].sum()
    assert none > 1.2 * four


def test_recording_has_every_channel_of_train_and_wheelsets(scenarios):
    recording = simulate(scenarios[0], record_every=0.05).recording
    assert recording is not None
    time = recording.channels["time"]
    np.testing.assert_allclose(np.diff(time), 0.05, rtol=1e-9)
    assert recording.units["clamping_force_4"] == "N"
    assert all(column.shape == time.shape for column in recording.channels.values())


def test_no_recording_unless_asked(stops):
    assert all(stop.recording is None for stop in stops.values())


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
    assert own is not None
    assert outside is not None
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
    assert cold is not None
    assert warm is not None
    added = {f"{name}_{n}" for name in ("disc_temperature", "disc_surface_temperature") for n in (1, 2, 3, 4)}
    assert set(warm.channels) - set(cold.channels) == added
    assert {warm.units[name] for name in added} == {"K"}
    assert (warm["disc_surface_temperature_2"][0], cold["pad_friction_1"][-1]) == (293.15, 0.38)
