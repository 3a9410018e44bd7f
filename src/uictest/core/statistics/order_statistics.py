"""Bounds of a quantile by order statistics: for any distribution, and none beyond what a sample supports.

Of n independent draws, the number that lie at or below the quantile of level p is binomial(n, p). The draw of
rank r is therefore at most that quantile with the probability P(B >= r) (David and Nagaraja, Order
Statistics, 3rd ed., section 7.1). Draws of equal value make a bound safer, never less safe.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

Side = Literal["lower", "upper", "both"]
"""Bounds of a quantile: one that lies below it, one above, or an interval."""


@dataclass(frozen=True, slots=True)
class BoundRanks:
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
