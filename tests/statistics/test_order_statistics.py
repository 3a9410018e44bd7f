"""Bounds of quantiles against binomial probabilities summed exactly, and against known distributions."""

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.special import bdtr, ndtri

from uictest.core.statistics import bound_ranks, draws_needed, quantile_rank

TRIALS = 200
levels = st.fractions(Fraction(1, 50), Fraction(49, 50), max_denominator=200)
confidences = st.sampled_from([0.5, 0.9, 0.95, 0.99])


def at_least(level, draws, successes):
    """The probability of so many or more successes, summed term by term."""
    terms = (math.comb(draws, k) * level**k * (1 - level) ** (draws - k) for k in range(successes, draws + 1))
    return sum(terms, Fraction(0))


@given(levels, st.integers(1, 60), confidences)
def test_the_lower_bound_is_the_innermost_draw_that_holds(level, draws, confidence):
    rank = bound_ranks(float(level), draws, confidence, "lower").lower or 0
    # A draw of rank r lies at or below the quantile where r draws or more do.
    assert rank == 0 or at_least(level, draws, rank) >= confidence - 1e-9
    assert rank == draws or at_least(level, draws, rank + 1) < confidence + 1e-9


@given(levels, st.integers(1, 60), confidences)
def test_the_upper_bound_mirrors_the_lower(level, draws, confidence):
    upper = bound_ranks(float(level), draws, confidence, "upper")
    mirrored = bound_ranks(float(1 - level), draws, confidence, "lower")
    assert (upper.lower, upper.upper) == (None, mirrored.lower)


@given(levels, st.integers(1, 60), confidences)
def test_an_interval_leaves_half_of_the_doubt_on_each_side(level, draws, confidence):
    both = bound_ranks(float(level), draws, confidence, "both")
    each = 0.5 * (1.0 + confidence)
    assert both.lower == bound_ranks(float(level), draws, each, "lower").lower
    assert both.upper == bound_ranks(float(level), draws, each, "upper").upper


@given(levels, confidences, st.sampled_from(["lower", "upper", "both"]))
def test_no_fewer_draws_than_needed_support_a_bound(level, confidence, side):
    needed = draws_needed(float(level), confidence, side)
    for draws, supported in ((needed, True), (needed - 1, False)):
        ranks = bound_ranks(float(level), draws, confidence, side)
        requested = {"lower": (ranks.lower,), "upper": (ranks.upper,)}.get(side, (ranks.lower, ranks.upper))
        assert (None not in requested) == supported


@pytest.mark.parametrize(
    ("tail", "draws"), [(1e-3, 2_995), (1e-4, 29_956), (1e-5, 299_572), (1e-6, 2_995_731)]
)
def test_published_numbers_of_draws(tail, draws):
    """The extreme of so many draws bounds the quantile with 95 % confidence: n = ln 0.05 / ln(1 - tail)."""
    assert draws_needed(tail, 0.95, "lower") == draws_needed(1.0 - tail, 0.95, "upper") == draws
    assert bound_ranks(tail, draws, 0.95, "lower").lower == 1
    assert bound_ranks(1.0 - tail, draws, 0.95, "upper").upper == 1


def test_the_tolerance_limit_of_wilks():
    """Wilks (1941): the extreme of 59 draws covers 95 % of a population with 95 % confidence."""
    assert draws_needed(0.95, 0.95, "upper") == 59


@pytest.mark.parametrize(
    ("level", "draws", "rank"), [(0.5, 5, 3), (0.5, 4, 2), (0.07, 100, 7), (0.001, 10, 1), (0.999, 1000, 999)]
)
def test_the_estimate_is_the_first_draw_with_the_share_at_or_below_it(level, draws, rank):
    assert quantile_rank(level, draws) == rank


def exponential(level):
    return -math.log1p(-level)


def loaded_die(level):
    """The smallest number of eyes whose share is reached: nine of ten throws show a six."""
    return next(eyes for eyes in range(1, 7) if level <= (0.02 * eyes if eyes < 6 else 1.0))


def normal_draws(generator, size):
    return generator.normal(size=size)


def exponential_draws(generator, size):
    return generator.exponential(size=size)


def thrown(generator, size):
    return generator.choice([1.0, 2.0, 3.0, 4.0, 5.0, 6.0], p=[0.02] * 5 + [0.9], size=size)


@pytest.mark.parametrize("level", [0.001, 0.01, 0.5, 0.99, 0.999])
@pytest.mark.parametrize("side", ["lower", "upper", "both"])
@pytest.mark.parametrize(
    ("draw", "quantile", "is_continuous"),
    [
        (normal_draws, lambda level: float(ndtri(level)), True),
        (exponential_draws, exponential, True),
        (thrown, loaded_die, False),
    ],
    ids=["normal", "exponential", "loaded die"],
)
def test_quantiles_of_known_distributions_lie_within_their_bounds(draw, quantile, is_continuous, side, level):
    """Of 200 samples, as many miss as the confidence allows; the seeds are fixed, so no run differs."""
    draws, confidence = 6_000, 0.95
    ranks = bound_ranks(level, draws, confidence, side)
    misses = 0
    for seed in range(TRIALS):
        values = np.sort(draw(np.random.default_rng(seed), draws))
        lower = -np.inf if ranks.lower is None else values[ranks.lower - 1]
        upper = np.inf if ranks.upper is None else values[draws - ranks.upper]
        misses += not lower <= quantile(level) <= upper
    # Misses are binomial with a probability of 5 % or less: more than this has a probability of 1e-6.
    most = next(k for k in range(TRIALS) if bdtr(k, TRIALS, 1.0 - confidence) >= 1.0 - 1e-6)
    assert misses <= most
    if is_continuous and side != "both" and 0.01 <= level <= 0.99:
        # The innermost draw that holds wastes little: some samples do miss.
        assert misses >= 1
