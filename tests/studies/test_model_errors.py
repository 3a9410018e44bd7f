from __future__ import annotations

import numpy as np
import pytest

from studies.model_errors import force_channel, force_error, pressure_error
from uictest.core.recording import Recording

UNITS = {
    "time": "s",
    "cylinder_pressure_1": "Pa",
    "measured_pressure_2": "Pa",
    "cylinder_pressure_2": "Pa",
    "cylinder_pressure_thermal_2": "Pa",
    "clamping_force_1": "N",
    "computed_force_full_2": "N",
}


@pytest.fixture
def recording() -> Recording:
    samples = ([0, 1, 2], [0, 3e5, 3e5], [0, 2.8e5, 3.1e5], [0, 3e5, 3.04e5], [0, 3e5, 2.98e5])
    forces = ([0, 8e3, 10e3], [0, 8.2e3, 9.5e3])
    channels = [np.array(each, dtype=float) for each in (*samples, *forces)]
    return Recording(dict(zip(UNITS, channels, strict=True)), UNITS)


@pytest.mark.parametrize(
    ("setting", "error"),
    [("none", 5.0), ("hysteresis", 5.0), ("cylinder", 1.0), ("full", 1.0), ("thermal", 0.5)],
)
def test_each_setting_is_judged_by_the_pressure_that_it_uses(
    recording: Recording, setting: str, error: float
) -> None:
    assert pressure_error(recording, setting, 4e5) == pytest.approx(error)


def test_the_true_pressure_may_be_compared_instead(recording: Recording) -> None:
    true = Recording(
        {**recording.channels, "tank_pressure_1": recording["cylinder_pressure_1"] + 2e3},
        {**UNITS, "tank_pressure_1": "Pa"},
    )
    assert pressure_error(true, "thermal", 4e5, "tank_pressure_1") == pytest.approx(1.0)


def test_a_force_error_is_a_share_of_the_largest_force(recording: Recording) -> None:
    assert force_error(recording, force_channel("full")) == pytest.approx(5.0)
