import math

import numpy as np
import pytest
from scipy import stats

from uictest.statistics import mean_interval


def test_the_interval_is_that_of_scipy() -> None:
    values = [18.2, 21.0, 19.4, 25.1, 17.7]
    expected = stats.t.interval(0.9, len(values) - 1, np.mean(values), stats.sem(values))
    assert mean_interval(values, 0.9) == pytest.approx(expected, rel=1e-12)


def test_one_value_has_no_interval() -> None:
    assert all(map(math.isnan, mean_interval([3.0])))


def test_it_holds_the_mean_as_often_as_it_says() -> None:
    draws = np.random.default_rng(1).normal(5.0, 2.0, (2000, 6))
    holding = sum(low <= 5.0 <= high for low, high in (mean_interval(list(row)) for row in draws))
    assert holding / 2000 == pytest.approx(0.95, abs=0.015)
