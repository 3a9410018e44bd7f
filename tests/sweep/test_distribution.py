"""Quantiles against scipy's distributions."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy import stats

from uictest.sweep.distribution import quantile
from uictest.sweep.model import Distribution

SHARES = np.linspace(0.0, 0.999, 50)


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ({"uniform": ["2 m", "6 m"]}, stats.uniform(2, 4).ppf),
        ({"log-uniform": [0.1, 10]}, stats.loguniform(0.1, 10).ppf),
        ({"triangular": [0, 1, 4]}, stats.triang(0.25, 0, 4).ppf),
        ({"triangular": [0, 4, 4]}, stats.triang(1.0, 0, 4).ppf),
        (
            {"normal": {"mean": 1, "deviation": 2, "lower": 0, "upper": 4}},
            stats.truncnorm(-0.5, 1.5, 1, 2).ppf,
        ),
    ],
)
def test_quantiles(given: dict[str, Any], expected: Callable[[Any], Any]) -> None:
    found = quantile(Distribution.model_validate(given))(SHARES)
    assert found == pytest.approx(expected(SHARES), rel=1e-9, abs=1e-12)


def test_a_choice_gives_places() -> None:
    places = quantile(Distribution(choice=("a", "b", "c")))(np.array([0.0, 0.34, 0.99, 1.0]))
    assert places.tolist() == [0.0, 1.0, 2.0, 2.0]
