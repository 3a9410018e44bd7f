"""Quantiles of measures and K_dry over the draws of a random sample."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import count
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.core.measures import column_unit
from uictest.core.statistics import BoundRanks, Side, bound_ranks, draws_needed, quantile_rank
from uictest.plans.scenario import WHEELSET_NUMBERS, KDryRequest, QuantileRequest
from uictest.plans.sweeps import Plan, random_sample
from uictest.report import DrawCount, KDry, KDryLevel, MeasureQuantiles, Quantile, WrittenValue

if TYPE_CHECKING:
    import pyarrow as pa


Values = NDArray[np.float64]
_FEWEST_NEW: Final = 512
"""New values that are sorted in together, at least: doing so for a few at a time would take longer."""


class SmallestValues:
    """The smallest of all values that were added, so many of them; holds at most about twice as many."""

    def __init__(self, count: int) -> None:
        self._count = count
        self._kept: Values = np.zeros(0)
        """In rising order."""
        self._new: list[Values] = []
        self._new_size = 0
        self._limit = np.inf
        """Values from here on are not among the smallest."""

    def add(self, values: Values) -> None:
        """Consider further values."""
        candidates = values[values < self._limit]
        if self._count and candidates.size:
            self._new.append(candidates)
            self._new_size += candidates.size
            if self._new_size > max(self._count, _FEWEST_NEW):
                self._merge()

    def of_rank(self, rank: int) -> float | None:
        """Return the value of a rank, 1 for the smallest; None where there are fewer values.

        Raises IndexError for a rank beyond the number to keep.
        """
        if rank > self._count:
            raise IndexError(f"rank {rank} of the {self._count} smallest values")
        if self._new:
            self._merge()
        return float(self._kept[rank - 1]) if 1 <= rank <= self._kept.size else None

    def _merge(self) -> None:
        values = np.sort(np.concatenate([self._kept, *self._new]))
        self._new, self._new_size = [], 0
        self._kept = values[: self._count]
        if self._kept.size == self._count:
            self._limit = float(self._kept[-1])


class RankedDraws:
    """Draws of one measure, of which ranks from both ends are requested afterwards.

    Memory grows with the ranks, not with the draws: 16 bytes for each rank between an end and the innermost
    rank, so that a bound far out on a tail takes little and the median of ten million draws 160 MB.
    """

    def __init__(self, from_smallest: int, from_largest: int) -> None:
        """Keep the draws of these and of all outer ranks."""
        self._smallest, self._largest = SmallestValues(from_smallest), SmallestValues(from_largest)
        self.draws = 0
        self.without_value = 0

    def add(self, values: Values) -> None:
        """Add draws; one that is not a finite number is one without a value."""
        known = values[np.isfinite(values)]
        self.draws += values.size
        self.without_value += values.size - known.size
        self._smallest.add(known)
        self._largest.add(-known)

    def lower(self, rank: int | None) -> float | None:
        """Return the draw of a rank from the smallest, draws without a value taken for the smallest.

        None where the rank is None or falls on a draw without a value.
        """
        return None if rank is None else self._smallest.of_rank(rank - self.without_value)

    def upper(self, rank: int | None) -> float | None:
        """Return the draw of a rank from the largest, draws without a value taken for the largest."""
        value = None if rank is None else self._largest.of_rank(rank - self.without_value)
        return None if value is None else -value


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


_STANDSTILL = "braking_distance_m"
"""Column of stops that came to a standstill: measures of the others are those of a part of a stop."""


_SLIDING = "sliding_time_s"
_MOST_SLIDING = 1.0
"""s: a wheelset that slides for longer slides, as `dry-stop-rolls` of uictest-wsp has it; chosen."""


class TailDraws:
    """The draws on which requested quantiles and K_dry depend; every chunk of the sweep is to be added."""

    def __init__(self, plan: Plan) -> None:
        sample = random_sample(plan)
        self._plan, self._size = plan, sample.size if sample else plan.size
        self._sliding = np.zeros(plan.size // self._size, int)
        levels = self._levels_by_column()
        self._draws = {
            column: [_kept(each) for _ in range(plan.size // self._size)] for column, each in levels.items()
        }

    def add(self, table: pa.Table) -> None:
        """Add the rows of a chunk."""
        if not self._draws:
            return
        combinations = table.column("index").to_numpy() // self._size
        stopped = np.isfinite(_numbers(table, _STANDSTILL))
        if self._plan.k_dry is not None:
            np.add.at(self._sliding, combinations, _slides(table))
        for column, draws in self._draws.items():
            values = np.where(stopped, _numbers(table, column), np.nan)
            for combination in np.unique(combinations).tolist():
                draws[combination].add(values[combinations == combination])

    def quantiles(self) -> Iterator[MeasureQuantiles]:
        """Yield the quantiles of each request at each combination of the listed values."""
        for request in self._plan.quantiles:
            for circumstances, draws in self._by_circumstances(request.measure):
                yield _quantiles(request, circumstances, draws)

    def k_dry(self) -> Iterator[KDry]:
        """Yield K_dry at each combination; without a stated nominal deceleration its bounds only."""
        if (request := self._plan.k_dry) is not None:
            of_each = zip(self._by_circumstances(request.measure), self._sliding.tolist(), strict=True)
            for (circumstances, draws), sliding in of_each:
                yield replace(_k_dry(request, circumstances, draws), sliding=sliding)

    def _levels_by_column(self) -> dict[str, list[BoundedQuantile]]:
        levels: dict[str, list[BoundedQuantile]] = {}
        for request in self._plan.quantiles:
            levels.setdefault(request.measure, []).extend(of_request(request, self._size))
        if (k_dry := self._plan.k_dry) is not None:
            levels.setdefault(k_dry.measure, []).extend(of_k_dry(k_dry, self._size))
        return levels

    def _by_circumstances(self, column: str) -> Iterator[tuple[dict[str, WrittenValue], RankedDraws]]:
        # A value that all cases share tells no two tables apart.
        varied = [key for group in self._plan.groups[:-1] if group.size > 1 for key in group.keys]
        for combination, draws in enumerate(self._draws[column]):
            settings = self._plan.settings(np.array([combination * self._size]))
            yield {key: WrittenValue(settings[key][0].text) for key in varied}, draws


def _kept(levels: Sequence[BoundedQuantile]) -> RankedDraws:
    return RankedDraws(
        max(level.from_smallest for level in levels), max(level.from_largest for level in levels)
    )


def _numbers(table: pa.Table, column: str) -> NDArray[Any]:
    return np.array(table.column(column).to_numpy(zero_copy_only=False), float)


def _slides(table: pa.Table) -> NDArray[np.bool_]:
    """Return whether a wheelset slides in each case."""
    times = [_numbers(table, f"{_SLIDING}_{number}") for number in WHEELSET_NUMBERS]
    slides: NDArray[np.bool_] = np.any(np.array(times) > _MOST_SLIDING, axis=0)
    return slides


def _count(draws: RankedDraws) -> DrawCount:
    return DrawCount(draws=draws.draws, without_value=draws.without_value)


def _quantiles(
    request: QuantileRequest, circumstances: Mapping[str, WrittenValue], draws: RankedDraws
) -> MeasureQuantiles:
    return MeasureQuantiles(
        measure=request.measure,
        unit=column_unit(request.measure),
        circumstances=circumstances,
        confidence=float(request.confidence),
        sample=_count(draws),
        quantiles=tuple(level.of(draws) for level in of_request(request, draws.draws)),
    )


def _k_dry_level(ebcl: int, quantile: Quantile) -> KDryLevel:
    return KDryLevel(
        ebcl=ebcl,
        shortfall=quantile.level,
        draws_needed=quantile.draws_needed,
        deceleration=quantile.lower,
    )


def _k_dry(request: KDryRequest, circumstances: Mapping[str, WrittenValue], draws: RankedDraws) -> KDry:
    quantiles = [level.of(draws) for level in of_k_dry(request, draws.draws)]
    bounds = KDry(
        measure=request.measure,
        circumstances=circumstances,
        nominal=None,
        nominal_is_stated=request.nominal is not None,
        confidence=float(request.confidence),
        sample=_count(draws),
        levels=tuple(map(_k_dry_level, count(), quantiles)),
    )
    return bounds if request.nominal is None else bounds.over(float(request.nominal))
