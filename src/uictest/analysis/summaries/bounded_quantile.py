"""One quantile that a sweep requests: which draws bound it, and what they say."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from uictest.analysis.summaries.ranked_draws import RankedDraws
from uictest.core.statistics import BoundRanks, Side, bound_ranks, draws_needed, quantile_rank
from uictest.plans.sweeps import KDryRequest, QuantileRequest
from uictest.report import Quantile

SHORTFALLS: Final = (0.5, *(float(f"1e-{level}") for level in range(1, 10)))
"""Share of stops that may fall short, by emergency brake confidence level (SUBSET-026, 3.13.2.2.9)."""


@dataclass(frozen=True, slots=True)
class BoundedQuantile:
    """The quantile of a level, and the ranks of the draws that bound and estimate it in a sample."""

    level: float
    side: Side
    draws_needed: int
    bounds: BoundRanks
    estimate: BoundRanks
    """The rank of the estimate, from the nearer end."""

    @property
    def from_smallest(self) -> int:
        """Innermost rank from the smallest draw; 0 where none is needed."""
        return max(self.bounds.lower or 0, self.estimate.lower or 0)

    @property
    def from_largest(self) -> int:
        """Innermost rank from the largest draw; 0 where none is needed."""
        return max(self.bounds.upper or 0, self.estimate.upper or 0)

    def of(self, draws: RankedDraws) -> Quantile:
        """Return the quantile of a measure; nothing of it where a bound falls on a draw without a value."""
        lower, upper = draws.lower(self.bounds.lower), draws.upper(self.bounds.upper)
        if self.side == "both" and None in (lower, upper):
            lower = upper = None
        estimate = None
        if (lower, upper) != (None, None) and not draws.without_value:
            low, high = draws.lower(self.estimate.lower), draws.upper(self.estimate.upper)
            estimate = high if low is None else low
        return Quantile(
            level=self.level,
            side=self.side,
            draws_needed=self.draws_needed,
            estimate=estimate,
            lower=lower,
            upper=upper,
        )


def of_request(request: QuantileRequest, draws: int) -> Iterator[BoundedQuantile]:
    """Yield the quantiles of a request over so many draws."""
    for level in map(float, request.levels):
        yield _bounded(level, request.side_of(level), float(request.confidence), draws)


def of_k_dry(request: KDryRequest, draws: int) -> Iterator[BoundedQuantile]:
    """Yield the quantile of each emergency brake confidence level, from 0 on."""
    for shortfall in SHORTFALLS:
        yield _bounded(shortfall, "lower", float(request.confidence), draws)


def _bounded(level: float, side: Side, confidence: float, draws: int) -> BoundedQuantile:
    rank = quantile_rank(level, draws)
    is_in_lower_half = 2 * rank <= draws
    return BoundedQuantile(
        level=level,
        side=side,
        draws_needed=draws_needed(level, confidence, side),
        bounds=bound_ranks(level, draws, confidence, side),
        estimate=BoundRanks(lower=rank) if is_in_lower_half else BoundRanks(upper=draws + 1 - rank),
    )
