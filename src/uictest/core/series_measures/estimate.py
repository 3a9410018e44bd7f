"""What stops say of all stops like them: estimates with their confidence, alone or over the dry stops."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from statistics import median
from typing import Literal

from uictest.core import statistics

Method = Literal["median", "mean", "share", "largest", "smallest"]
"""How a value was made of those of the stops, and with it how its interval was."""


@dataclass(frozen=True, slots=True)
class Estimate:
    """A value over stops.

    Args:
        value: the estimate.
        low, high: the interval that holds the true one with `confidence`; NaN where there is none.
        confidence: of the interval, a share.
        method: median: interval by order statistics; mean: by Student's t; share: by Clopper and Pearson;
            largest and smallest: no interval, see `covered`. Over dry stops see :func:`over_dry`.
        stops: how many were drawn.
        smallest, largest: of the stops, the spread.
        covered: for the largest (smallest) of the stops: share of all such stops that, with `confidence`,
            keep on its good side; over dry stops on that of `high` (`low`). NaN otherwise.
        dry_stops: over the mean of how many the value is; 0 where it does not refer to them.
        dry_scatter: whether these show how they scatter; there is neither an interval nor a cover otherwise.

    """

    value: float
    low: float
    high: float
    confidence: float
    method: Method
    stops: int
    smallest: float
    largest: float
    covered: float = math.nan
    dry_stops: int = 0
    dry_scatter: bool = True

    def mapped(self, function: Callable[[float], float]) -> Estimate:
        """Return the estimate of a monotone function of the value."""
        ends = self.low, self.high
        low, high = sorted(math.nan if math.isnan(end) else function(end) for end in ends)
        smallest, largest = sorted((function(self.smallest), function(self.largest)))
        value = function(self.value)
        return replace(self, value=value, low=low, high=high, smallest=smallest, largest=largest)


_FEWEST_EQUAL = 5
"""Dry stops from which equal ones are known to scatter by nothing; a few may be equal by rounding; chosen."""
Statistic = Callable[[Sequence[float], float], Estimate]
"""Makes an estimate of the values of stops (at least one, all finite) and a confidence."""


def median_of(values: Sequence[float], confidence: float) -> Estimate:
    """Return the median with its interval by order statistics, whatever the distribution.

    95 % take at least six values.
    """
    rank, ranked = statistics.median_rank(len(values), confidence), sorted(values)
    low, high = (math.nan, math.nan) if rank is None else (ranked[rank - 1], ranked[-rank])
    return _estimate(median(values), low, high, confidence, "median", values)


def mean_of(values: Sequence[float], confidence: float) -> Estimate:
    """Return the mean with its interval by Student's t."""
    low, high = statistics.mean_interval(values, confidence)
    return _estimate(math.fsum(values) / len(values), low, high, confidence, "mean", values)


def share_of(values: Sequence[float], confidence: float) -> Estimate:
    """Return the share (%) of values that are 1, the others 0, with its interval by Clopper and Pearson."""
    successes = sum(value == 1.0 for value in values)
    low, high = statistics.proportion_interval(successes, len(values), confidence)
    shares = [100.0 * value for value in values]
    share = 100.0 * successes / len(values)
    return _estimate(share, 100.0 * low, 100.0 * high, confidence, "share", shares)


def largest_of(values: Sequence[float], confidence: float) -> Estimate:
    """Return the largest value, and the share of all such stops that stays below it."""
    return _extreme(max(values), values, confidence, "largest")


def smallest_of(values: Sequence[float], confidence: float) -> Estimate:
    """Return the smallest value, and the share of all such stops that stays above it."""
    return _extreme(min(values), values, confidence, "smallest")


def _extreme(value: float, values: Sequence[float], confidence: float, method: Method) -> Estimate:
    whole = _estimate(value, math.nan, math.nan, confidence, method, values)
    return replace(whole, covered=_covered(len(values), confidence))


def _covered(stops: int, confidence: float) -> float:
    # All n draws stay below the quantile of order q with probability q^n; with n = 50 q is 94.2 % for 95 %.
    return float((1.0 - confidence) ** (1.0 / stops))


def _estimate(
    value: float, low: float, high: float, confidence: float, method: Method, values: Sequence[float]
) -> Estimate:
    return Estimate(value, low, high, confidence, method, len(values), min(values), max(values))


@dataclass(frozen=True, slots=True)
class SeriesValue:
    """A measure of a series: an estimate, or why there is none."""

    estimate: Estimate | None = None
    unavailable_reason: str = ""


def estimated(values: Sequence[float], statistic: Statistic, confidence: float) -> SeriesValue:
    """Return the estimate of some values, or how many of them are missing."""
    if not values:
        return SeriesValue(unavailable_reason="no wet stop counts")
    missing = sum(not math.isfinite(value) for value in values)
    if missing:
        return SeriesValue(unavailable_reason=f"{missing} of {len(values)} wet stops have no such number")
    return SeriesValue(statistic(values, confidence))


def over_dry(estimate: Estimate, dry: Sequence[float]) -> Estimate:
    """Return an estimate over the mean of dry stops, above zero, as a ratio with the scatter of both.

    The interval is that of :func:`uictest.core.statistics.ratio_interval`. Of the largest (smallest) value
    it is the value over both ends of that of the mean, and the covered share holds for `high` (`low`); what
    may fail is halved between both (Bonferroni). Dry stops that show no scatter make neither.
    """
    mean = mean_of(dry, estimate.confidence)
    ratio = replace(estimate.mapped(lambda value: value / mean.value), dry_stops=len(dry))
    if len(dry) < _FEWEST_EQUAL and min(dry) == max(dry):
        return replace(ratio, low=math.nan, high=math.nan, covered=math.nan, dry_scatter=False)
    if estimate.method not in ("largest", "smallest"):
        ends, half_width = (estimate.low, estimate.high), mean.high - mean.value
        low, high = statistics.ratio_interval(estimate.value, ends, mean.value, half_width)
        return replace(ratio, low=low, high=high)
    if not mean.low > 0.0:
        return replace(ratio, covered=math.nan)
    covered = _covered(estimate.stops, 0.5 + 0.5 * estimate.confidence)
    low, high = sorted((estimate.value / mean.low, estimate.value / mean.high))
    return replace(ratio, covered=covered, low=low, high=high)
