"""What a fit takes from a record: torques by forces, and no track brake."""

import numpy as np
import pytest

from uictest.core.recording import TIME
from uictest.recorded.field_data import WHEELSETS, Preparation, RawChannel, prepare, stated_case
from uictest.recorded.fitting.samples import FitError, samples_of
from uictest.rig import simulate


def test_forces_say_the_torque_of_pads_that_do_not_vary():
    """By calipers, pads, radius and friction, each wheelset with its own: the rig records both."""
    own = "{1: {brake_force: 80 %}, 4: {pad_friction: 0.45}}"
    settings = ["rail.condition=wet", "rail.friction=0.07", f"vehicle.wheelsets={own}"]
    case = stated_case("stop", 80.0 / 3.6, settings)
    recording = simulate(case, record_every=0.01).recording
    time = np.asarray(recording[TIME])
    names = [f"{kind}_{n}" for n in WHEELSETS for kind in ("wheel_speed", "clamping_force", "brake_torque")]
    channels = {
        name: RawChannel(name, name, time, np.array(recording[name], dtype=float))
        for name in ("speed", *names)
    }
    torques = []
    for without in ("brake_torque", "clamping_force"):
        kept = {name: each for name, each in channels.items() if not name.startswith(without)}
        samples = samples_of(prepare(kept, recording.metadata, Preparation()), case.scenario)
        assert samples.torque is not None
        torques.append(np.where(samples.standing, 0.0, samples.torque))
    by_forces, recorded = torques
    assert recorded.max() > 1e3
    rolling = np.abs(by_forces - recorded) < 1e-3 * recorded.max()
    assert rolling.mean() > 0.98


def test_a_stop_that_a_track_brake_slowed_as_well_is_no_stop_for_a_fit(recorded_stop):
    case, stop = recorded_stop(60, 0.06, settings=["brake.track={attraction: 100 kN, when: always}"])
    with pytest.raises(FitError, match="a track brake slowed the train"):
        samples_of(stop, case.scenario)
