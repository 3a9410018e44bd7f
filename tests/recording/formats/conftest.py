"""A small recording in every format."""

import numpy as np
import pytest

from uictest.core.recording import Recording
from uictest.core.recording.formats import FORMATS, isolation, writer_of

from ...conftest import READ_APART


@pytest.fixture(autouse=True)
def _isolated(monkeypatch):
    """Here a process of its own is the point."""
    monkeypatch.setattr(isolation, "read_apart", READ_APART)


@pytest.fixture
def recording():
    """Two seconds of a train that slows down while a valve changes state."""
    time = np.arange(200) * 0.01
    channels = {
        "time": time,
        "speed": 20.0 - time,
        "tank_pressure_1": 3.8e5 * np.minimum(time, 1.0),
        "valve_command_1": np.repeat([0.0, 1.0, 2.0, 0.0], 50),
        "vent_magnet_1": np.repeat([0.0, 0.0, 1.0, 0.0], 50),
        "diagnosis": np.repeat([0.0, 1.0, 2.0**31, 2.0**32 - 1.0], 50),
    }
    units = {"time": "s", "speed": "m/s", "tank_pressure_1": "Pa", "valve_command_1": "1"}
    units |= {"vent_magnet_1": "1", "diagnosis": "1"}
    return Recording(channels, units, {"case": "small", "brake_command_time": "0 s"})


@pytest.fixture
def written(recording, tmp_path):
    """Write the recording in a format."""

    def write(name):
        path = tmp_path / f"small{FORMATS[name].suffix}"
        writer_of(name)(recording, path)
        return path

    return write
