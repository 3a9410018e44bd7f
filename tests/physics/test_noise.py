"""Threefry-2x32-20 against its published vectors, and the moments of the bell."""

import math
from itertools import product

import numpy as np
import pytest

from uictest.core.physics.sensors import bell, threefry

ALL_ONES = 0xFFFFFFFF
# Known answers of the authors' Random123 library (kat_vectors): key, counter, random bits.
KNOWN_ANSWERS = [
    ((0, 0), (0, 0), (0x6B200159, 0x99BA4EFE)),
    ((ALL_ONES, ALL_ONES), (ALL_ONES, ALL_ONES), (0x1CB996FC, 0xBB002BE7)),
    ((0x13198A2E, 0x03707344), (0x243F6A88, 0x85A308D3), (0xC4923A9C, 0x483DF7A0)),
]
DRAWS = 1 << 15


@pytest.mark.parametrize(("key", "counter", "bits"), KNOWN_ANSWERS)
def test_known_answers(key, counter, bits):
    assert threefry(*key, *counter) == bits


def test_known_answers_hold_for_the_integers_of_a_record_and_the_bell_is_bounded_and_symmetric():
    """Numpy's signed 64-bit integers must not overflow in the rotations."""
    key, counter, bits = KNOWN_ANSWERS[1]
    assert threefry(*map(np.int64, key), *map(np.int64, counter)) == bits
    assert bell(ALL_ONES, ALL_ONES) == -bell(0, 0) < 2.0 * math.sqrt(3.0)


@pytest.fixture(scope="module")
def draws():
    """One channel's noise over many samples."""
    return np.array([bell(*threefry(7, 11, sample, 3)) for sample in range(DRAWS)])


def test_bell_has_the_moments_of_four_uniform_numbers_and_successive_samples_are_unrelated(draws):
    """The excess kurtosis of one uniform number is -6/5, that of a sum of n is -6/(5 n)."""
    error = 4.0 / math.sqrt(DRAWS)
    assert draws.mean() == pytest.approx(0.0, abs=error)
    assert draws.var() == pytest.approx(1.0, abs=error * math.sqrt(1.7))
    assert np.mean(draws**3) == pytest.approx(0.0, abs=error * math.sqrt(10.0))
    assert np.mean(draws**4) == pytest.approx(3.0 - 6.0 / 20.0, abs=error * math.sqrt(40.0))
    correlations = [np.mean(draws[lag:] * draws[:-lag]) for lag in (1, 2, 20)]
    np.testing.assert_allclose(correlations, 0.0, atol=4.0 / math.sqrt(DRAWS))


def test_channels_seeds_and_cases_are_unrelated():
    keys = list(product((0, 1), (0, 1), (0, 1)))
    series = [[bell(*threefry(seed, case, k, channel)) for k in range(2000)] for seed, case, channel in keys]
    correlations = np.corrcoef(series) - np.eye(len(keys))
    np.testing.assert_allclose(correlations, 0.0, atol=5.0 / math.sqrt(2000))
