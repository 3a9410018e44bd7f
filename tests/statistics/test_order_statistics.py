"""The interval of a median against binomial probabilities summed exactly, and known distributions."""

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.special import bdtr

from uictest.core.statistics import draws_for_median, median_rank

TRIALS = 200
confidences = st.sampled_from([0.5, 0.9, 0.95, 0.99])


def at_least(draws, successes):
    """The probability of so many or more heads, summed term by term."""
    return Fraction(sum(math.comb(draws, k) for k in range(successes, draws + 1)), 2**draws)


@given(st.integers(1, 60), confidences)
def test_the_ends_are_the_innermost_draws_that_leave_half_of_the_doubt_on_each_side(draws, confidence):
    rank, each = median_rank(draws, confidence) or 0, 0.5 * (1.0 + confidence)
    # A draw of rank r lies at or below the median where r draws or more do.
    assert rank == 0 or at_least(draws, rank) >= each - 1e-9
    assert rank == draws or at_least(draws, rank + 1) < each + 1e-9


@given(st.floats(0.01, 0.9999))
def test_no_fewer_draws_than_needed_have_an_interval(confidence):
    needed = draws_for_median(confidence)
    assert median_rank(needed, confidence) == 1
    assert median_rank(needed - 1, confidence) is None


def test_published_ranks():
    """From tables of the binomial distribution: the 40th and the 61st of 100 draws, six draws at least."""
    assert median_rank(100, 0.95) == 40
    assert draws_for_median(0.95) == 6


@pytest.mark.parametrize(
    ("draw", "median"),
    [
        (lambda generator, size: generator.normal(size=size), 0.0),
        (lambda generator, size: generator.exponential(size=size), math.log(2.0)),
        (lambda generator, size: generator.choice([1.0, 5.0, 6.0], p=[0.02, 0.08, 0.9], size=size), 6.0),
    ],
    ids=["normal", "exponential", "loaded die"],
)
def test_medians_of_known_distributions_lie_within_their_intervals(draw, median):
    """Of 200 samples, as many miss as the confidence allows; the seeds are fixed, so no run differs."""
    draws, confidence = 6_000, 0.95
    rank = median_rank(draws, confidence)
    misses = 0
    for seed in range(TRIALS):
        values = np.sort(draw(np.random.default_rng(seed), draws))
        misses += not values[rank - 1] <= median <= values[draws - rank]
    # Misses are binomial with a probability of 5 % or less: more than this has a probability of 1e-6.
    most = next(k for k in range(TRIALS) if bdtr(k, TRIALS, 1.0 - confidence) >= 1.0 - 1e-6)
    assert misses <= most
