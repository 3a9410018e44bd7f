"""Two parameters against each other: the share of cases met, or the mean of a measure, in every cell."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from uictest.analysis.summaries.bins import ParameterBins
from uictest.analysis.summaries.trends import numbers_or_none
from uictest.plans.sweeps import Plan
from uictest.report import MET, MapAxis, SweepMap

if TYPE_CHECKING:
    import pyarrow as pa


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
