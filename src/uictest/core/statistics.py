"""Statistics of counts and of samples: how well a sample knows a mean or a median, trials a probability."""

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


def ratio_interval(
    value: float, interval: tuple[float, float], mean: float, half_width: float
) -> tuple[float, float]:
    """Return the interval of an estimate over an independent mean whose interval is `mean` -+ `half_width`.

    MOVER-R of Donner and Zou (Stat. Methods Med. Res. 21 (2012) 347): with value v, low l and half width h,
    each over the mean, the lower end is (v - sqrt((v h)^2 + (v - l)^2 (1 - h^2))) / (1 - h^2). For two means
    with Student's t it is the theorem of Fieller (1954), with the quantile of each sample: one quantile by
    Welch and Satterthwaite holds too little beside two or three values (simulated: 87 % instead of 95 %). NaN
    at both ends where an interval is missing, or that of the mean reaches zero.
    """
    if not (mean > 0.0 and all(map(math.isfinite, interval))):
        return math.nan, math.nan
    ratio, share = value / mean, half_width / mean
    if not (rest := 1.0 - share**2) > 0.0:
        return math.nan, math.nan
    below, above = (math.hypot(ratio * share, (ratio - end / mean) * math.sqrt(rest)) for end in interval)
    return (ratio - below) / rest, (ratio + above) / rest


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


def median_rank(draws: int, confidence: float) -> int | None:
    """Return the rank, from either end, of the innermost draws that bound the median; None if none do.

    Half of the error probability lies on each side. Of n independent draws, the number at or below the
    median is binomial(n, 1/2), so that the draw of rank r is at most the median with the probability
    P(B >= r) (David and Nagaraja, Order Statistics, 3rd ed., section 7.1), for any distribution. Draws of
    equal value make the interval safer, never less safe.
    """
    from scipy.special import betainc

    one_sided = 0.5 * (1.0 + confidence)
    # Up to some rank all draws bound, beyond it none: the interval is halved.
    known, beyond = 0, draws + 1
    while beyond - known > 1:
        middle = (known + beyond) // 2
        bounds = betainc(middle, draws - middle + 1, 0.5) >= one_sided
        known, beyond = (middle, beyond) if bounds else (known, middle)
    return known or None


def draws_for_median(confidence: float) -> int:
    """Return the fewest draws whose extremes bound the median: all lie on one side with 2 (1/2)^n."""
    draws = 1
    while 1.0 - 0.5 ** (draws - 1) < confidence:
        draws += 1
    return draws
