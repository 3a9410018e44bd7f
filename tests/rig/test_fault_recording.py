"""What a recording shows of faults."""

import numpy as np

from uictest.rig import simulate

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


def test_a_stop_without_faults_has_no_channel_of_them(rig):
    recording = simulate(rig.case(*SHORT), 0.01).recording
    assert not {"active_faults", "speed_valid_1"} & set(recording.channels)
    assert "faults" not in recording.metadata
