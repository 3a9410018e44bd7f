"""Simulated stops as a train would record them: with the noise and the errors of sensors."""

import numpy as np

from uictest.core.recording import TIME
from uictest.recorded.field_data import Preparation, RawChannel, prepare, stated_case
from uictest.rig import simulate

NOISE = {"speed": 0.05, "wheel_speed": 0.03, "clamping_force": 50.0}
"""Standard deviations, m/s and N; wheel speeds are read by the rig's toothed wheels besides."""
LOADCELL_GAIN = 0.005
"""Standard deviation of the gain errors of loadcells, share."""


def _with_sensor_noise(recording, dice):
    time = np.asarray(recording[TIME])

    def noise(kind):
        return dice.normal(0.0, NOISE[kind], len(time))

    samples = {"speed": recording["speed"] + noise("speed")}
    for n in (1, 2, 3, 4):
        samples[f"wheel_speed_{n}"] = recording[f"measured_speed_{n}"] + noise("wheel_speed")
        gain = 1.0 + dice.normal(0.0, LOADCELL_GAIN)
        samples[f"clamping_force_{n}"] = gain * recording[f"clamping_force_{n}"] + noise("clamping_force")
    return {name: RawChannel(name, name, time, np.asarray(values)) for name, values in samples.items()}


def recorded_stop(speed, friction, seed=0, without=(), every=0.01, **facts):
    """Simulate a stop from a speed in km/h on a friction, and record it with the sensor noise of a seed.

    A sample `every` so many seconds.
    """
    wsp = facts.get("wsp", "active")
    case = stated_case(
        "stop",
        speed / 3.6,
        ["rail.condition=wet", f"rail.friction={friction}", f"rig.wsp={wsp}", *facts.get("settings", ())],
    )
    recording = simulate(case, record_every=every).recording
    channels = _with_sensor_noise(recording, np.random.default_rng(seed))
    kept = {name: c for name, c in channels.items() if not name.startswith(without or ("-",))}
    return case, prepare(kept, recording.metadata, Preparation())
