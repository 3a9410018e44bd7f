"""Intervals of means, medians and probabilities."""

import math
from fractions import Fraction
from math import comb

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy import stats
from scipy.special import bdtr

from uictest.core.statistics import (
    draws_for_median,
    mean_interval,
    median_rank,
    next_interval,
    proportion_interval,
    trials_needed,
)


@pytest.mark.parametrize(("interval", "share"), [(mean_interval, 1 / 5), (next_interval, 1.0 + 1 / 5)])
def test_an_interval_of_the_mean_or_of_the_next_draw_is_that_of_the_textbook(interval, share):
    """By SciPy's t; `share` is the variance of what is estimated over that of a draw. One value has none."""
    values = [18.2, 21.0, 19.4, 25.1, 17.7]
    scale = np.std(values, ddof=1) * math.sqrt(share)
    expected = stats.t.interval(0.9, len(values) - 1, np.mean(values), scale)
    assert interval(values, 0.9) == pytest.approx(expected, rel=1e-12)
    assert all(map(math.isnan, interval([3.0])))


def test_they_hold_the_mean_and_the_next_draw_as_often_as_they_say():
    draws = np.random.default_rng(1).normal(5.0, 2.0, (2000, 6))
    holding = sum(low <= 5.0 <= high for low, high in (mean_interval(list(row)) for row in draws))
    assert holding / 2000 == pytest.approx(0.95, abs=0.015)
    draws = np.random.default_rng(2).normal(5.0, 2.0, (2000, 5))
    intervals = (next_interval(list(row[:4])) for row in draws)
    holding = sum(low <= row[4] <= high for row, (low, high) in zip(draws, intervals, strict=True))
    assert holding / 2000 == pytest.approx(0.95, abs=0.015)


def test_with_many_draws_it_is_two_standard_deviations_wide_on_either_side():
    draws = np.random.default_rng(3).normal(0.0, 1.0, 20_000)
    low, high = next_interval(list(draws))
    assert (high - low) / 2.0 == pytest.approx(1.96 * float(np.std(draws)), rel=1e-3)


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


def so_many_or_more(successes, trials, probability):
    """Return the probability of so many successes or more, summed term by term."""
    terms = (
        comb(trials, k) * probability**k * (1.0 - probability) ** (trials - k)
        for k in range(successes, trials + 1)
    )
    return sum(terms)


@pytest.mark.parametrize(
    ("successes", "trials", "confidence", "low", "high"),
    [
        # Newcombe, Statistics in Medicine 17 (1998) 857-872, table I, method 5 (Clopper-Pearson).
        (81, 263, 0.95, 0.2527, 0.3676),
        (15, 148, 0.95, 0.0578, 0.1617),
        (0, 20, 0.95, 0.0, 0.1684),
        (1, 29, 0.95, 0.0009, 0.1776),
        # The rule of Clopper and Pearson for 10 of 10, (alpha / 2) ** (1 / 10).
        (10, 10, 0.95, 0.6915, 1.0),
        (10, 10, 0.90, 0.7411, 1.0),
    ],
)
def test_published_intervals(successes, trials, confidence, low, high):
    assert proportion_interval(successes, trials, confidence) == pytest.approx((low, high), abs=5e-5)


@given(trials=st.integers(1, 60), data=st.data())
def test_each_end_is_where_the_binomial_tail_is_half_of_what_remains(trials, data):
    successes = data.draw(st.integers(0, trials))
    low, high = proportion_interval(successes, trials)
    assert 0.0 <= low <= successes / trials <= high <= 1.0
    if successes > 0:
        assert so_many_or_more(successes, trials, low) == pytest.approx(0.025, rel=1e-9)
    if successes < trials:
        assert 1.0 - so_many_or_more(successes + 1, trials, high) == pytest.approx(0.025, rel=1e-9)


@given(trials=st.integers(1, 200), data=st.data())
def test_successes_and_failures_are_mirror_images(trials, data):
    successes = data.draw(st.integers(0, trials))
    low, high = proportion_interval(successes, trials)
    assert proportion_interval(trials - successes, trials) == pytest.approx(
        (1.0 - high, 1.0 - low), abs=1e-12
    )


@given(probability=st.floats(0.01, 0.999))
def test_the_trials_needed_are_the_fewest(probability):
    needed = trials_needed(probability)
    assert needed is not None
    assert proportion_interval(needed, needed)[0] >= probability - 1e-9
    if needed > 1:
        assert proportion_interval(needed - 1, needed - 1)[0] < probability + 1e-9


@pytest.mark.parametrize(("probability", "needed"), [(0.9, 36), (0.5, 6), (0.99, 368), (1.0, None), (0.0, 1)])
def test_how_many_stops_can_show_a_share(probability, needed):
    assert trials_needed(probability) == needed


@pytest.mark.parametrize(("successes", "trials"), [(3, 2), (-1, 2), (0, 0)])
def test_counts_that_cannot_be_are_rejected(successes, trials):
    with pytest.raises(ValueError, match=f"{successes} successes in {trials} trials"):
        proportion_interval(successes, trials)
