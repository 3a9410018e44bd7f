from itertools import pairwise

import numpy as np
from hypothesis import given, strategies as st
from hypothesis.extra.numpy import arrays

from uictest.report.page.stop.polyline import REVERSAL, pieces


def test_a_cycle_rises_and_falls():
    x = np.array([0.0, 1.0, 2.0, 3.0, 2.0, 1.0, 0.0, 2.0])
    assert pieces(x) == [(0, 3, 1), (3, 6, -1), (6, 7, 1)]
    assert pieces(np.array([3.0, 2.0, 1.0])) == [(0, 2, -1)]
    assert len(pieces(np.full(3, np.nan))) <= 1
    assert pieces(np.zeros(0)) == []


def test_noise_turns_nothing():
    ramp = np.linspace(0.0, 1.0, 200)
    noise = 0.4 * REVERSAL * np.where(np.arange(200) % 2, 1.0, -1.0)
    assert pieces(ramp + noise) == [(0, 199, 1)]


@given(arrays(np.float64, st.integers(0, 60), elements=st.floats(-10, 10)))
def test_pieces_join_and_each_goes_its_way(x):
    found = pieces(x)
    assert all(last == after for (_, last, _), (after, _, _) in pairwise(found))
    assert all(first < last for first, last, _ in found)
    for first, last, direction in found:
        assert direction * (x[last] - x[first]) >= 0.0
    if found:
        assert (found[0][0], found[-1][1]) == (0, len(x) - 1)
