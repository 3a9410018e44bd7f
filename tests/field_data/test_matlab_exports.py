"""Stops that Simulink exported, selected by a channel map."""

import numpy as np
from scipy.io import savemat

from uictest.core.recording.formats import Dialect
from uictest.core.recording.formats.reader import read_here
from uictest.recorded.field_data import load_map
from uictest.recorded.field_data.proposal import channel_rows
from uictest.recorded.field_data.raw_channels import select_channels

MAP = """schema: uictest/channel-map/1
name: simulink
channels:
  speed: {source: "v[1]", unit: km/h}
  "wheel_speed_{n}": {source: "v[2]", unit: km/h}
"""


def test_columns_of_a_structure_with_time_are_selected_by_their_number_over_its_time(tmp_path):
    time = np.arange(50) * 0.2
    values = np.stack([80.0 - 3.6 * time, 79.0 - 3.6 * time], axis=1)
    path = tmp_path / "stop.mat"
    savemat(path, {"simout": {"time": time[:, None], "signals": {"values": values, "label": "v"}}})
    (tmp_path / "map.yaml").write_text(MAP)
    contents = read_here("mat", path, Dialect())
    assert [row[0] for row in channel_rows(contents)] == ["v[1]", "v[2]"]
    channels = select_channels(contents, load_map(str(tmp_path / "map.yaml"))[0])
    np.testing.assert_array_equal(channels["speed"].time, time)
    np.testing.assert_allclose(channels["speed"].samples, values[:, 0] / 3.6)
    np.testing.assert_allclose(channels["wheel_speed_3"].samples, values[:, 1] / 3.6)
