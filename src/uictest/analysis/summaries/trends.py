"""The measures that reports of a sweep show: their ends, along a parameter, and over two parameters."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.analysis.summaries.tally import ParameterBins
from uictest.core.measures import column_unit
from uictest.plans.sweeps import ListedGroup, Plan
from uictest.report import MET, VALID, MapAxis, MeasureRange, SweepMap, Trend
from uictest.running.chunked import wheelset_columns

if TYPE_CHECKING:
    import pyarrow as pa


@dataclass(frozen=True)
class ReportedMeasure:
    """A measure that reports show: the largest of some columns of the rows, times a scale."""

    name: str
    unit: str
    columns: tuple[str, ...]
    scale: float = 1.0

    def of(self, table: pa.Table) -> NDArray[np.float64]:
        """Return the measure of each row, NaN where it has no value."""
        columns = [
            np.array(table.column(name).to_numpy(zero_copy_only=False), float) for name in self.columns
        ]
        largest: NDArray[np.float64] = np.fmax.reduce(columns) * self.scale
        return largest


USUAL: Final = (
    ReportedMeasure("braking distance", "m", ("braking_distance_m",)),
    ReportedMeasure("braking time", "s", ("braking_time_s",)),
    ReportedMeasure("largest slide above {}", "%", wheelset_columns("maximum_slide"), 100.0),
    ReportedMeasure("most valve actuations of a wheelset", "1", wheelset_columns("valve_actuations")),
    ReportedMeasure("initial adhesion", "g", ("initial_adhesion_g",)),
)


def reported_measures(measures: Sequence[str], moving_speed: str) -> list[ReportedMeasure]:
    """Return the usual measures and the other columns that are requested.

    `moving_speed` is the train speed, as text, above which the largest slide counts.
    """
    usual = {name for measure in USUAL for name in measure.columns}
    return [
        *(replace(each, name=each.name.format(moving_speed)) for each in USUAL),
        *(ReportedMeasure(name, column_unit(name), (name,)) for name in measures if name not in usual),
    ]


@dataclass
class MeasureSums:
    """The ends and the sum of a measure over the rows that have it, added chunk by chunk."""

    measure: ReportedMeasure
    minimum: float = np.inf
    maximum: float = -np.inf
    cases: int = 0
    _sum: float = 0.0

    def add(self, table: pa.Table) -> None:
        """Add the rows of a chunk."""
        values = self.measure.of(table)
        values = values[np.isfinite(values)]
        if values.size:
            self.minimum = min(self.minimum, float(values.min()))
            self.maximum = max(self.maximum, float(values.max()))
            self.cases += values.size
            self._sum += float(values.sum())

    def range(self) -> MeasureRange:
        """Return the trends of the rows that were added; there must be one with the measure."""
        return MeasureRange(
            measure=self.measure.name,
            unit=self.measure.unit,
            columns=self.measure.columns,
            cases=self.cases,
            minimum=self.minimum,
            mean=self._sum / self.cases,
            maximum=self.maximum,
        )


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
        self._met, self._cases, self._valid = (np.zeros(shape, np.int64) for _ in range(3))

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
        np.add.at(self._valid, (down, across), np.isin(table.column("outcome").to_pylist(), VALID))

    def map(self) -> SweepMap:
        """Return the map of the rows that were added."""
        return SweepMap(
            self.measure,
            MapAxis(self.rows.key, self.rows.values),
            MapAxis(self.columns.key, self.columns.values),
            means=numbers_or_none(self._sum / np.where(self._known > 0, self._known, np.nan)),
            met=self._met.tolist(),
            cases=self._cases.tolist(),
            valid=self._valid.tolist(),
            known=self._known.tolist(),
        )
