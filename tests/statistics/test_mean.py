import math

import numpy as np
import pytest
from scipy import stats

from uictest.core.statistics import mean_interval, next_interval


def test_the_interval_is_that_of_scipy():
    values = [18.2, 21.0, 19.4, 25.1, 17.7]
    expected = stats.t.interval(0.9, len(values) - 1, np.mean(values), stats.sem(values))
    assert mean_interval(values, 0.9) == pytest.approx(expected, rel=1e-12)


def test_one_value_has_no_interval():
    assert all(map(math.isnan, mean_interval([3.0])))


def test_it_holds_the_mean_as_often_as_it_says():
    draws = np.random.default_rng(1).normal(5.0, 2.0, (2000, 6))
    holding = sum(low <= 5.0 <= high for low, high in (mean_interval(list(row)) for row in draws))
    assert holding / 2000 == pytest.approx(0.95, abs=0.015)


def test_the_interval_of_the_next_draw_is_that_of_the_textbook():
    values = [18.2, 21.0, 19.4, 25.1, 17.7]
    scale = np.std(values, ddof=1) * math.sqrt(1.0 + 1.0 / len(values))
    expected = stats.t.interval(0.9, len(values) - 1, np.mean(values), scale)
    assert next_interval(values, 0.9) == pytest.approx(expected, rel=1e-12)


def test_one_value_says_nothing_of_the_next():
    assert all(map(math.isnan, next_interval([3.0])))


def test_it_holds_the_next_draw_as_often_as_it_says():
    draws = np.random.default_rng(2).normal(5.0, 2.0, (2000, 5))
    intervals = (next_interval(list(row[:4])) for row in draws)
    holding = sum(low <= row[4] <= high for row, (low, high) in zip(draws, intervals, strict=True))
    assert holding / 2000 == pytest.approx(0.95, abs=0.015)


def test_with_many_draws_it_is_two_standard_deviations_wide_on_either_side():
    draws = np.random.default_rng(3).normal(0.0, 1.0, 20_000)
    low, high = next_interval(list(draws))
    assert (high - low) / 2.0 == pytest.approx(1.96 * float(np.std(draws)), rel=1e-3)
