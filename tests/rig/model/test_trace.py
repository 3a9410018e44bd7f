"""A recording's samples."""

import numpy as np
import pytest

from uictest.rig.model.trace import SLIDE_SPEED

SLIDING = ("rail.condition=wet", "rail.friction=0.08", "initial_speed=60 km/h")


@pytest.mark.parametrize("every", [1, 7, 20, 200])
def test_samples_are_evenly_spaced_from_the_brake_command_on(rig, every):
    """Each time is a multiple of the step and never a sum."""
    outcome = rig.stop(*SLIDING, every=every)
    times = outcome.trace.train["time"]
    np.testing.assert_array_equal(times, every * np.arange(len(times)) * 5e-4)
    assert outcome.car.time - times[-1] < every * 5e-4


def test_every_channel_has_numbers_that_agree_with_the_others(rig):
    trace = rig.columns(*SLIDING, every=20)
    assert len(trace) == 40
    assert all(np.isfinite(column).all() for column in trace.values())
    moving = trace["speed"] > SLIDE_SPEED
    slide = 1.0 - trace["wheel_speed"][moving] / trace["speed"][moving, None]
    np.testing.assert_allclose(trace["slide"][moving], slide, atol=1e-12)
    assert not np.any(trace["slide"][~moving])
    assert np.all(trace["adhesion"] <= trace["friction"] + 1e-9)
    assert set(np.unique(trace["valve_command"])) <= {0.0, 1.0, 2.0}
    assert np.all(np.diff(trace["distance"][moving]) > 0.0)


def test_the_magnets_say_what_the_command_says(rig):
    """Neither fills, hold alone holds, both vent."""
    trace = rig.columns(*SLIDING, every=20)
    magnets = {0.0: (0.0, 0.0), 1.0: (1.0, 0.0), 2.0: (1.0, 1.0)}
    commands = trace["valve_command"]
    assert set(np.unique(commands)) == set(magnets)
    for command, (hold, vent) in magnets.items():
        assert set(trace["hold_magnet"][commands == command]) == {hold}
        assert set(trace["vent_magnet"][commands == command]) == {vent}


def test_first_sample_is_as_true_as_the_others(rig):
    """At the brake command the wheels roll on the rail that lies there, and the sensors see it."""
    first = {name: column[0] for name, column in rig.columns(*SLIDING, every=20).items()}
    assert first["time"] == first["distance"] == 0.0
    np.testing.assert_allclose(first["friction"], 0.08)
    np.testing.assert_allclose(first["wheel_speed"], 60.0 / 3.6)
    np.testing.assert_allclose(first["measured_speed"], 60.0 / 3.6, rtol=5e-3)


def test_each_controller_records_its_own_estimate(rig):
    """On a good rail both estimates follow the train."""
    for controller in ("threshold", "slip-band"):
        trace = rig.columns(f"controller={controller}", every=20)
        moving = trace["speed"] > 3.0
        np.testing.assert_allclose(
            trace["reference_speed"][moving], trace["speed"][moving], rtol=0.01, atol=0.05
        )


def test_on_a_very_slippery_rail_the_naive_estimate_sinks_with_the_wheels_and_the_other_recovers(rig):
    """The slip-band controller loses the train's speed and its wheels lock; it is there to show that."""
    slippery, naive = ("rail.condition=wet", "rail.friction=0.03"), "controller=slip-band"
    trace = rig.columns(*slippery, naive, every=20)
    after = np.searchsorted(trace["time"], 15.0)
    assert trace["reference_speed"][after] < 0.2 * trace["speed"][after]
    assert np.all(trace["wheel_speed"][after] == 0.0)
    locks = [rig.stop(*slippery, *own, every=20).wheelset_measures.longest_lock for own in ((), (naive,))]
    assert locks[0].max() < 0.1 * locks[1].min()
