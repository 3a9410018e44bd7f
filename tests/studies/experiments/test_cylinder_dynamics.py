from __future__ import annotations

import numpy as np
import pytest

from uictest.recording import Recording
from uictest.studies.experiments.cylinder_dynamics import largest_errors
from uictest.studies.experiments.force_accuracy import largest_error


def test_errors_are_shares_whatever_their_sign() -> None:
    recording = Recording(
        {
            "time": np.arange(3.0),
            "tank_pressure_1": np.array([0.0, 3e5, 3e5]),
            "tank_pressure_2": np.array([0.0, 2.8e5, 3.1e5]),
            "cylinder_pressure_2": np.array([0.0, 3e5, 3.04e5]),
            "clamping_force_1": np.array([0.0, 8e3, 10e3]),
            "computed_force_full_2": np.array([0.0, 8.2e3, 9.5e3]),
        },
        {
            "time": "s",
            "tank_pressure_1": "Pa",
            "tank_pressure_2": "Pa",
            "cylinder_pressure_2": "Pa",
            "clamping_force_1": "N",
            "computed_force_full_2": "N",
        },
    )
    assert largest_errors(recording, 4e5) == pytest.approx((0.05, 0.01))
    assert largest_error(recording, "computed_force_full_2") == pytest.approx(0.05)
