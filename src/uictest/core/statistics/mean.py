"""How well a sample knows a mean, a number of trials a probability."""

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


def proportion_interval(successes: int, trials: int, confidence: float = 0.95) -> tuple[float, float]:
    """Return the interval of Clopper and Pearson (1934) for a probability, of which `successes` were counted.

    It contains the probability at least with this confidence, half of the rest on each side, whatever the
    probability and however few the trials. Raises ValueError for counts that cannot be.
    """
    if not 0 <= successes <= trials or trials < 1:
        raise ValueError(f"{successes} successes in {trials} trials")
    from scipy.special import betaincinv

    alpha = 1.0 - confidence
    low = 0.0 if successes == 0 else betaincinv(successes, trials - successes + 1, alpha / 2)
    high = 1.0 if successes == trials else betaincinv(successes + 1, trials - successes, 1 - alpha / 2)
    return float(low), float(high)


def trials_needed(probability: float, confidence: float = 0.95) -> int | None:
    """Return the fewest trials whose interval lies at or above `probability` if all of them succeed.

    None for a probability of 1, which no number of trials can show.
    """
    if probability >= 1.0:
        return None
    if probability <= 0.0:
        return 1
    # The lower end with n successes in n trials is (alpha / 2) ** (1 / n).
    return max(math.ceil(math.log((1.0 - confidence) / 2) / math.log(probability) - 1e-9), 1)
