"""The measures that reports of a sweep show, and what all cases together come to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from uictest.core.measures import column_unit
from uictest.report import MeasureRange
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
        """Return what the rows that were added come to; there must be one with the measure."""
        return MeasureRange(
            measure=self.measure.name,
            unit=self.measure.unit,
            columns=self.measure.columns,
            cases=self.cases,
            minimum=self.minimum,
            mean=self._sum / self.cases,
            maximum=self.maximum,
        )
