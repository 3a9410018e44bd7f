"""What of many stops, alike but for some numbers, lies outside of what was validated: column by column."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from uictest.analysis.validation.domain import (
    Conditions,
    Domain,
    Range,
    holds,
    inside_of_other_parts,
    outside_of,
)
from uictest.judging.evaluation import Deviation

Columns = Mapping[str, NDArray[np.float64]]
"""Key of a number -> its value in each stop, SI."""


@dataclass(frozen=True, slots=True)
class DeviationOfStops:
    """One condition beyond what was validated, and in which of the stops; `found` holds those of all."""

    deviation: Deviation
    stops: NDArray[np.bool_]


def deviations_of_stops(
    domains: Sequence[Domain], stops: int, conditions: Conditions, columns: Columns
) -> Iterator[DeviationOfStops]:
    """Yield what of stops lies outside of the domain that each comes nearest to, as `deviations` of each.

    Args:
        domains: at least one.
        stops: their number.
        conditions: of one of the stops; the others differ in the numbers of `columns` alone.
        columns: numbers of every stop, by keys that `conditions` have.
    """
    outside = [_Outside.of(domain.conditions, stops, conditions, columns) for domain in domains]
    nearest = np.argmin([each.counts for each in outside], axis=0)
    for place, each in enumerate(outside):
        yield from each.deviations(nearest == place, conditions, columns)


@dataclass(frozen=True, slots=True)
class _Outside:
    """What of stops lies outside of one domain: the same in all of them, and by number in which."""

    shared: Sequence[Deviation]
    by_key: Mapping[str, NDArray[np.bool_]]
    bounds: Mapping[str, Range]
    counts: NDArray[np.int64]

    @classmethod
    def of(cls, validated: Conditions, stops: int, stop: Conditions, columns: Columns) -> _Outside:
        shared = list(outside_of(_without(validated, columns), _without(stop, columns)))
        inside = inside_of_other_parts(validated, stop)
        by_key = {
            key: _beyond(validated.ranges.get(key), values)
            for key, values in columns.items()
            if not key.startswith(inside)
        }
        counts = np.full(stops, len(shared)) + sum(by_key.values(), np.zeros(stops, np.int64))
        return cls(shared, by_key, validated.ranges, counts)

    def deviations(
        self, nearest: NDArray[np.bool_], stop: Conditions, columns: Columns
    ) -> Iterator[DeviationOfStops]:
        """Yield what lies outside of those stops that come nearest to this domain."""
        if nearest.any():
            yield from (DeviationOfStops(each, nearest) for each in self.shared)
        for key, beyond in self.by_key.items():
            stops = beyond & nearest
            if stops.any():
                found = (float(columns[key][stops].min()), float(columns[key][stops].max()))
                bounds = self.bounds.get(key)
                validated = None if bounds is None else (bounds.lowest, bounds.highest)
                yield DeviationOfStops(Deviation(key, found, validated, stop.ranges[key].unit), stops)


def _without(conditions: Conditions, columns: Columns) -> Conditions:
    ranges = {key: each for key, each in conditions.ranges.items() if key not in columns}
    return replace(conditions, ranges=ranges)


def _beyond(bounds: Range | None, values: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return which values lie outside; all of them where there are no bounds."""
    inside: NDArray[np.bool_] = (
        np.zeros(values.size, bool) if bounds is None else holds(bounds, values, values)
    )
    return ~inside
