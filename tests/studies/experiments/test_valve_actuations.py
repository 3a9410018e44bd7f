import numpy as np

from studies.experiments.valve_actuations import ActuationPanel, openings
from uictest.core.recording import Recording


def test_an_opening_is_marked_where_the_vent_begins():
    commands = np.array([0, 2, 2, 1, 2, 0, 0])
    recording = Recording(
        {"time": np.arange(7.0), "valve_command_2": commands}, {"time": "s", "valve_command_2": "1"}
    )
    assert openings(ActuationPanel("module 2", recording, 2, "none")).tolist() == [1, 4]
