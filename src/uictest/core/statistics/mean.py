"""How well a sample knows a mean, and the next draw."""

from __future__ import annotations

import math
from collections.abc import Sequence


def mean_interval(values: Sequence[float], confidence: float = 0.95) -> tuple[float, float]:
    """Return the interval of the mean of what some values were drawn from; NaN at both ends for one value.

    Student's t: exact for normal draws, and near the stated confidence for the mean of many others.
    """
    mean, variance, factor = _of_sample(values, confidence)
    half = factor * math.sqrt(variance / len(values))
    return mean - half, mean + half


def next_interval(values: Sequence[float], confidence: float = 0.95) -> tuple[float, float]:
    """Return the interval of one further draw; NaN at both ends for one value.

    Student's t, m +- t s sqrt(1 + 1 / n): exact for normal draws, however few. With many it comes to the mean
    plus or minus 1.96 standard deviations; with few it is wider.
    """
    mean, variance, factor = _of_sample(values, confidence)
    half = factor * math.sqrt(variance * (1.0 + 1.0 / len(values)))
    return mean - half, mean + half


def _of_sample(values: Sequence[float], confidence: float) -> tuple[float, float, float]:
    """Return mean, variance and the quantile of Student's t; NaN for what one value lacks."""
    count = len(values)
    if count < 2:
        return math.nan, math.nan, math.nan
    from scipy.special import stdtrit  # here, for what only checks a file judges no draws

    mean = math.fsum(values) / count
    variance = math.fsum((value - mean) ** 2 for value in values) / (count - 1)
    return mean, variance, float(stdtrit(count - 1, 0.5 + confidence / 2.0))
