"""Statistics of counts and of samples.

How well a sample knows a mean, a number of trials a probability; and bounds of a quantile by order
statistics, for any distribution, and none beyond what a sample supports. Of n independent draws, the number
that lie at or below the quantile of level p is binomial(n, p). The draw of rank r is therefore at most that
quantile with the probability P(B >= r) (David and Nagaraja, Order Statistics, 3rd ed., section 7.1). Draws of
equal value make a bound safer, never less safe.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Literal, NamedTuple

Side = Literal["lower", "upper", "both"]
"""Bounds of a quantile: one that lies below it, one above, or an interval."""


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


class BoundRanks(NamedTuple):
    """Ranks of the draws that bound a quantile: 1 is the smallest draw for `lower`, the largest for `upper`.

    None where the bound is not requested, or no draw is one.
    """

    lower: int | None = None
    upper: int | None = None


def bound_ranks(level: float, draws: int, confidence: float, side: Side) -> BoundRanks:
    """Return the innermost draws that bound the quantile of a level with at least this confidence.

    Args:
        level: probability of a value at or below the quantile, between 0 and 1.
        draws: size of the sample.
        confidence: of the bound; of `both` half of the rest lies on each side.
        side: the bounds to return.

    """
    each = _confidence_of_each(confidence, side)
    return BoundRanks(
        None if side == "upper" else _last_rank(lambda k: _is_below(level, draws, k) >= each, draws),
        None if side == "lower" else _last_rank(lambda k: _is_above(level, draws, k) >= each, draws),
    )


def draws_needed(level: float, confidence: float, side: Side) -> int:
    """Return the fewest draws of which one bounds the quantile on each requested side; arguments as above."""
    each = _confidence_of_each(confidence, side)
    lower = upper = 1
    if side != "upper":
        lower = _fewest(each, math.log1p(-level), lambda draws: _is_below(level, draws, 1))
    if side != "lower":
        upper = _fewest(each, math.log(level), lambda draws: _is_above(level, draws, 1))
    return max(lower, upper)


def quantile_rank(level: float, draws: int) -> int:
    """Return the rank, from the smallest, of the draw that estimates a quantile: the inverse of the steps."""
    # Rounded, so that 7 % of 100 draws is the seventh: the product of the two floats lies above 7.
    return max(math.ceil(round(level * draws, 6)), 1)


def _confidence_of_each(confidence: float, side: Side) -> float:
    return 0.5 * (1.0 + confidence) if side == "both" else confidence


def _is_below(level: float, draws: int, rank: int) -> float:
    """Return the probability that the draw of a rank from the smallest lies at or below the quantile."""
    from scipy.special import betainc

    return float(betainc(rank, draws - rank + 1, level))


def _is_above(level: float, draws: int, rank: int) -> float:
    """Return the probability that the draw of a rank from the largest lies at or above the quantile."""
    from scipy.special import betaincc

    return float(betaincc(draws - rank + 1, rank, level))


def _last_rank(bounds: Callable[[int], bool], draws: int) -> int | None:
    """Return the largest rank that bounds: up to some rank all do, beyond none."""
    known, beyond = 0, draws + 1
    while beyond - known > 1:
        middle = (known + beyond) // 2
        known, beyond = (middle, beyond) if bounds(middle) else (known, middle)
    return known or None


def _fewest(confidence: float, log_inside: float, confidence_of: Callable[[int], float]) -> int:
    """Return the fewest draws of which the extreme bounds; all n lie inside with probability inside**n."""
    draws = max(math.ceil(math.log1p(-confidence) / log_inside) - 1, 1)
    while confidence_of(draws) < confidence:
        draws += 1
    return draws
