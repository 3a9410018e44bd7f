"""Distributions of the measures of a sweep: histograms by outcome, in two passes over the chunks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from uictest.analysis.summaries.tally import OUTCOMES
from uictest.core.measures import column_unit
from uictest.report import MeasureHistogram
from uictest.running.chunked import wheelset_columns

if TYPE_CHECKING:
    import pyarrow as pa

_BINS: Final = 30
_MOST_WHOLE: Final = 40
"""Most values of a whole-number measure for which each value has its own bin."""


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
class HistogramCounts:
    """Cases by bin of a measure and outcome.

    Call `add_range` for every chunk, then `open_bins`, then `add` for every chunk.
    """

    measure: ReportedMeasure
    minimum: float = np.inf
    maximum: float = -np.inf
    cases: int = 0
    _sum: float = 0.0
    _whole: bool = True
    _edges: NDArray[np.float64] = field(default_factory=lambda: np.zeros(0))
    _counts: NDArray[np.int64] = field(default_factory=lambda: np.zeros((0, 0), np.int64))

    def add_range(self, table: pa.Table) -> None:
        """Widen the range to the rows of a chunk."""
        values = self.measure.of(table)
        values = values[np.isfinite(values)]
        if values.size:
            self.minimum = min(self.minimum, float(values.min()))
            self.maximum = max(self.maximum, float(values.max()))
            self.cases += values.size
            self._sum += float(values.sum())
            self._whole &= bool(np.all(values == np.round(values)))

    def open_bins(self) -> None:
        """Divide the range into bins. There must be a case."""
        span = self.maximum - self.minimum
        if self._whole and span <= _MOST_WHOLE:
            self._edges = np.arange(self.minimum, self.maximum + 2.0) - 0.5
        else:
            margin = 0.0 if span else max(abs(self.minimum), 1.0) * 1e-3
            self._edges = np.linspace(self.minimum - margin, self.maximum + margin, _BINS + 1)
        self._counts = np.zeros((len(OUTCOMES), self._edges.size - 1), np.int64)

    def add(self, table: pa.Table) -> None:
        """Count the rows of a chunk."""
        values = self.measure.of(table)
        outcomes = np.array(table.column("outcome").to_pylist())
        for place, outcome in enumerate(OUTCOMES):
            of_outcome = values[(outcomes == outcome) & np.isfinite(values)]
            self._counts[place] += np.histogram(of_outcome, self._edges)[0]

    def histogram(self) -> MeasureHistogram:
        """Return the histogram of the rows that were added."""
        counts = zip(OUTCOMES, self._counts.tolist(), strict=True)
        return MeasureHistogram(
            measure=self.measure.name,
            unit=self.measure.unit,
            columns=self.measure.columns,
            cases=self.cases,
            minimum=self.minimum,
            mean=self._sum / self.cases,
            maximum=self.maximum,
            edges=self._edges.tolist(),
            counts={outcome: row for outcome, row in counts if any(row)},
        )
