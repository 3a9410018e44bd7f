"""Measures along a parameter, and two parameters against each other."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.analysis.summaries.reported_measures import ReportedMeasure
from uictest.analysis.summaries.tally import ParameterBins
from uictest.plans.sweeps import ListedGroup, Plan
from uictest.report import MET, MapAxis, SweepMap, Trend

if TYPE_CHECKING:
    import pyarrow as pa


MOST_VALUES: Final = 200
"""Largest number of values for which a parameter has trends; with more, plot the rows themselves."""


class TrendSums:
    """Measures over the bins of one parameter, added chunk by chunk.

    Along listed values a mean, and its ends, are those of the same cases at every value: a combination of the
    other parameters counts where its case has the measure at all values at which any case has it. So chunks
    are read twice: :meth:`note` says which cases have a measure, :meth:`add` adds them. Drawn values share no
    cases: each counts.
    """

    def __init__(self, plan: Plan, bins: ParameterBins, measures: Sequence[ReportedMeasure]) -> None:
        self.bins, self.measures = bins, measures
        self._plan = plan
        shape = (len(measures), len(bins.values))
        self._cases, self._sum = np.zeros(shape, np.int64), np.zeros(shape)
        self._minimum, self._maximum = np.full(shape, np.inf), np.full(shape, -np.inf)
        place, group = bins.place[0], plan.groups[bins.place[0]]
        self._listed = isinstance(group, ListedGroup)
        self._below = math.prod(each.size for each in plan.groups[place + 1 :])
        combinations = plan.size // group.size if self._listed else 0
        self._values_of = np.zeros((len(measures), combinations), np.int32)
        self._used = np.zeros((len(measures), group.size if self._listed else 0), bool)

    def note(self, table: pa.Table) -> None:
        """Note which rows of a chunk have each measure."""
        if not self._listed:
            return
        indices = table.column("index").to_numpy()
        rows, others = self._row_and_others(indices)
        for place, measure in enumerate(self.measures):
            known = np.isfinite(measure.of(table))
            np.add.at(self._values_of[place], others[known], 1)
            self._used[place, rows[known]] = True

    def add(self, table: pa.Table) -> None:
        """Add the rows of a chunk, once all are noted."""
        indices = table.column("index").to_numpy()
        bins = self.bins.of(self._plan, indices, table)
        for place, measure in enumerate(self.measures):
            values = measure.of(table)
            counts = np.isfinite(values)
            if self._listed:
                _, others = self._row_and_others(indices)
                counts &= self._values_of[place, others] == np.count_nonzero(self._used[place])
            at, values = bins[counts], values[counts]
            np.add.at(self._cases[place], at, 1)
            np.add.at(self._sum[place], at, values)
            np.minimum.at(self._minimum[place], at, values)
            np.maximum.at(self._maximum[place], at, values)

    def _row_and_others(self, indices: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return the row of its group that each case has, and the number of its other values."""
        size = self._plan.groups[self.bins.place[0]].size
        above, within = indices // self._below, indices % self._below
        return above % size, above // size * self._below + within

    def trends(self) -> Iterator[Trend]:
        """Yield the trend of each measure that any cases have that can be compared."""
        for place, measure in enumerate(self.measures):
            cases = self._cases[place]
            if cases.any():
                yield Trend(
                    parameter=self.bins.key,
                    values=self.bins.values,
                    measure=measure.name,
                    unit=measure.unit,
                    columns=measure.columns,
                    cases=cases.tolist(),
                    minimum=numbers_or_none(self._minimum[place]),
                    mean=numbers_or_none(self._sum[place] / np.where(cases > 0, cases, np.nan)),
                    maximum=numbers_or_none(self._maximum[place]),
                )


def numbers_or_none(values: NDArray[np.float64]) -> list[Any]:
    """Return an array as nested lists of floats, None for what is not finite."""
    objects: NDArray[Any] = values.astype(object)
    objects[~np.isfinite(values)] = None
    numbers: list[Any] = objects.tolist()
    return numbers


class MapSums:
    """Sums over the cases of each cell, added chunk by chunk."""

    def __init__(self, plan: Plan, rows: ParameterBins, columns: ParameterBins, measure: str) -> None:
        self.rows, self.columns, self.measure = rows, columns, measure
        self._plan = plan
        shape = (len(rows.values), len(columns.values))
        self._sum, self._known = np.zeros(shape), np.zeros(shape, np.int64)
        self._met, self._cases = np.zeros(shape, np.int64), np.zeros(shape, np.int64)

    def add(self, table: pa.Table) -> None:
        """Add the rows of a chunk; a case without the measure does not count in its mean."""
        indices = table.column("index").to_numpy()
        values = np.array(table.column(self.measure).to_numpy(zero_copy_only=False), float)
        known = np.isfinite(values)
        down, across = (each.of(self._plan, indices, table) for each in (self.rows, self.columns))
        np.add.at(self._sum, (down[known], across[known]), values[known])
        np.add.at(self._known, (down[known], across[known]), 1)
        np.add.at(self._met, (down, across), np.array(table.column(MET).to_pylist(), bool))
        np.add.at(self._cases, (down, across), 1)

    def map(self) -> SweepMap:
        """Return the map of the rows that were added."""
        return SweepMap(
            self.measure,
            MapAxis(self.rows.key, self.rows.values),
            MapAxis(self.columns.key, self.columns.values),
            means=numbers_or_none(self._sum / np.where(self._known > 0, self._known, np.nan)),
            met=self._met.tolist(),
            cases=self._cases.tolist(),
            known=self._known.tolist(),
        )
