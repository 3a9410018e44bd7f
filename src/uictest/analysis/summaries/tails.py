"""Quantiles of measures and K_dry over the draws of a random sample, added chunk by chunk."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import count
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from uictest.analysis.summaries.bounded_quantile import BoundedQuantile, of_k_dry, of_request
from uictest.analysis.summaries.ranked_draws import RankedDraws
from uictest.core.measures import column_unit
from uictest.plans.scenario import WHEELSET_NUMBERS
from uictest.plans.sweeps import KDryRequest, Plan, QuantileRequest, random_sample
from uictest.report import DrawCount, KDry, KDryLevel, MeasureQuantiles, Quantile, WrittenValue

if TYPE_CHECKING:
    import pyarrow as pa

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
