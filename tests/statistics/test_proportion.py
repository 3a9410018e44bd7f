"""Intervals of a probability against published values and against the binomial distribution itself."""

from math import comb

import pytest
from hypothesis import given, strategies as st

from uictest.core.statistics import proportion_interval, trials_needed


def at_least(successes, trials, probability):
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
        assert at_least(successes, trials, low) == pytest.approx(0.025, rel=1e-9)
    if successes < trials:
        assert 1.0 - at_least(successes + 1, trials, high) == pytest.approx(0.025, rel=1e-9)


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
