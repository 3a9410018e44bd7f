import math

import numpy as np
import pytest
from hypothesis import given, strategies

from uictest.core.series_measures.estimate import largest_of, mean_of, median_of, share_of, smallest_of


def test_the_interval_of_the_median_has_known_ranks_and_holds_it_in_samples():
    # P(at most 1 of 10 fair draws) = 11/1024 on each side: 97.9 %; the third to the eighth give 89 %.
    estimate = median_of([float(n) for n in range(1, 11)], 0.95)
    assert (estimate.value, estimate.low, estimate.high) == (5.5, 2.0, 9.0)
    assert math.isnan(median_of([1.0, 2.0, 3.0, 4.0, 5.0], 0.95).low)
    assert (median_of([6.0, 1.0, 2.0, 3.0, 4.0, 5.0], 0.95).low) == 1.0
    draws = np.random.default_rng(3).exponential(1.0, (2000, 25))
    estimates = [median_of(list(row), 0.95) for row in draws]
    held = sum(each.low <= math.log(2.0) <= each.high for each in estimates)
    assert held / 2000 >= 0.945


def test_a_share_has_the_interval_of_clopper_and_pearson():
    estimate = share_of([1.0] * 6 + [0.0] * 4, 0.95)
    # The published example of six of ten.
    assert (estimate.value, estimate.low, estimate.high) == pytest.approx((60.0, 26.24, 87.84), abs=5e-3)


def test_the_largest_of_59_covers_95_percent_of_all_stops():
    assert largest_of([0.0] * 59, 0.95).covered >= 0.95
    assert largest_of([0.0] * 58, 0.95).covered < 0.95
    assert math.isnan(largest_of([1.0, 2.0], 0.95).low)


@given(strategies.lists(strategies.floats(-1e6, 1e6), min_size=1, max_size=40))
def test_every_value_lies_within_the_spread_and_its_interval(values):
    for statistic in (median_of, mean_of, largest_of, smallest_of):
        estimate = statistic(values, 0.95)
        air = 1e-9 * max(map(abs, values))
        assert estimate.smallest - air <= estimate.value <= estimate.largest + air
        assert not estimate.value < estimate.low - air
        assert not estimate.value > estimate.high + air


def test_a_falling_function_turns_the_interval_around():
    estimate = mean_of([1.0, 2.0, 3.0], 0.95).mapped(lambda value: -value)
    assert estimate.low < estimate.value == -2.0 < estimate.high
    assert (estimate.smallest, estimate.largest) == (-3.0, -1.0)
