import numpy as np
import pytest

from uictest.core.recording import Recording

TIME = np.array([0.0, 0.5, 1.0])


def recording(channels, **units):
    return Recording(channels, {"time": "s", **units})


def test_a_recording_gives_its_length_and_its_channels_and_says_which_there_are():
    it = recording({"time": TIME, "speed": np.array([3.0, np.nan, 1.0])}, speed="m/s")
    assert len(it) == 3
    assert it["speed"][0] == 3.0
    with pytest.raises(KeyError, match="no channel 'sped' in this recording of time, speed"):
        recording({"time": TIME, "speed": TIME}, speed="m/s")["sped"]


@pytest.mark.parametrize(
    ("channels", "units", "message"),
    [
        ({}, {}, "first channel of a recording must be 'time', found: none"),
        ({"speed": TIME, "time": TIME}, {"speed": "m/s"}, "must be 'time', found: speed, time"),
        ({"time": TIME, "speed": TIME[:2]}, {"speed": "m/s"}, "'speed' has 2 samples, 'time' has 3"),
        ({"time": TIME, "speed": TIME[:, None]}, {"speed": "m/s"}, "'speed' has 2 dimensions"),
        ({"time": TIME, "note": np.array(["a", "b", "c"])}, {"note": "1"}, "'note' holds <U1"),
        ({"time": np.array([0.0, np.nan, 1.0])}, {}, "'time' is not finite at sample 1"),
        ({"time": np.array([0.0, 1.0, np.inf])}, {}, "'time' is not finite at sample 2"),
        ({"time": np.array([0.0, 1.0, 1.0])}, {}, "'time' does not increase at sample 2: 1.0 s, then 1.0 s"),
        ({"time": TIME, "speed": TIME}, {}, "no unit for speed"),
        ({"time": TIME}, {"speed": "m/s"}, "units for missing channels: speed"),
        ({"time": TIME}, {"time": "ms"}, "'time' must be in \"s\", found 'ms'"),
    ],
)
def test_what_is_no_recording_is_refused(channels, units, message):
    with pytest.raises(ValueError, match=message.replace("(", r"\(")):
        recording(channels, **units)
