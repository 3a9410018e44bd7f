"""Points are a function of seed and number alone."""

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.stats import qmc

from uictest.plans.sweeps.sampling import points

METHODS = ["random", "sobol", "latin-hypercube", "saltelli"]


@pytest.mark.parametrize("method", METHODS)
@given(data=st.data())
def test_any_points_are_those_of_the_whole(method, data):
    rows = 64 * 5 if method == "saltelli" else 64
    whole = points(method, 64, 3, 7, np.arange(rows))
    some = np.array(data.draw(st.lists(st.integers(0, rows - 1), min_size=1, max_size=20)))
    assert np.array_equal(points(method, 64, 3, 7, some), whole[some])


@pytest.mark.parametrize("method", METHODS)
def test_another_seed_gives_other_points_inside_the_cube(method):
    one, other = (points(method, 32, 2, seed, np.arange(32)) for seed in (1, 2))
    assert not np.array_equal(one, other)
    assert one.min() >= 0.0
    assert one.max() < 1.0


@pytest.mark.parametrize("method", METHODS)
def test_no_points_are_none_of_the_whole(method):
    assert points(method, 64, 3, 7, np.arange(0)).shape == (0, 3)


def test_samples_are_those_of_their_method():
    drawn = points("random", 3000, 2, 0, np.arange(3000))
    assert np.unique(drawn, axis=0).shape == (3000, 2)
    assert np.mean(drawn, axis=0) == pytest.approx([0.5, 0.5], abs=0.03)
    expected = qmc.Sobol(3, scramble=True, rng=5).random(16)
    assert np.array_equal(points("sobol", 16, 3, 5, np.arange(16)), expected)
    drawn = points("latin-hypercube", 20, 3, 0, np.arange(20))
    for column in drawn.T:
        assert sorted((column * 20).astype(int)) == list(range(20))
    rows = points("saltelli", 8, 2, 0, np.arange(8 * 4)).reshape(8, 4, 2)
    a, b, first, second = rows.transpose(1, 0, 2)
    assert np.array_equal(first, np.stack([b[:, 0], a[:, 1]], axis=1))
    assert np.array_equal(second, np.stack([a[:, 0], b[:, 1]], axis=1))
