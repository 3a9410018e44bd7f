"""Robust lines."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.rig.identification.lines import robust_line

PRESSURE = np.linspace(1e5, 4e5, 400)


@given(st.floats(1e-3, 0.2), st.floats(-5e3, 5e3))
def test_a_line_without_noise_is_found_exactly(slope, intercept):
    line = robust_line(PRESSURE, slope * PRESSURE + intercept)
    assert line.slope == pytest.approx(slope, rel=1e-6)
    assert line.intercept == pytest.approx(intercept, abs=1e-6 * slope * 4e5 + 1e-6)


def test_points_on_one_side_move_it_less_than_least_squares():
    rng = np.random.default_rng(1)
    force = 0.045 * PRESSURE - 1700.0 + 20.0 * rng.standard_normal(len(PRESSURE))
    force[:60] += 1500.0
    line = robust_line(PRESSURE, force)
    assert abs(line.slope - 0.045) < 0.2 * abs(np.polyfit(PRESSURE, force, 1)[0] - 0.045)


def test_the_confidence_covers_the_truth_about_nineteen_times_in_twenty():
    covered = 0
    for seed in range(60):
        noise = 50.0 * np.random.default_rng(seed).standard_normal(len(PRESSURE))
        line = robust_line(PRESSURE, 0.045 * PRESSURE - 1700.0 + noise)
        covered += abs(line.slope - 0.045) <= line.slope_confidence
    assert 48 <= covered <= 60


def test_too_few_points_are_no_line():
    with pytest.raises(ValueError, match="3 points"):
        robust_line(PRESSURE[:3], PRESSURE[:3])
