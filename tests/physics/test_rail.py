"""Friction along the track and in time."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.core.physics.rail import interpolated

places = st.lists(st.floats(-1e3, 1e3), min_size=1, max_size=20, unique=True).map(sorted)


@given(places, st.floats(-2e3, 2e3))
def test_between_points_it_is_numpys_linear_interpolation(x, at):
    values = np.random.default_rng(len(x)).uniform(0.02, 0.6, len(x))
    expected = np.interp(at, x, values)
    assert interpolated(at, x, values, len(x)) == pytest.approx(expected, rel=1e-9)


def test_two_points_at_one_place_make_a_step_also_at_the_end_and_none_count_beyond():
    """The later of the two holds at the place itself."""
    x, y = [0.0, 150.0, 150.0, 300.0], [0.25, 0.25, 0.08, 0.08]
    assert interpolated(np.nextafter(150.0, 0.0), x, y, 4) == 0.25
    assert interpolated(150.0, x, y, 4) == 0.08
    assert interpolated(150.0, [0.0, 150.0, 150.0], [0.3, 0.3, 0.1], 3) == 0.1
    # The rows of the two laws of a rail have one length; the shorter law ends earlier.
    assert interpolated(9.0, [0.0, 1.0, 0.0, 0.0], [0.3, 0.2, 0.0, 0.0], 2) == 0.2
