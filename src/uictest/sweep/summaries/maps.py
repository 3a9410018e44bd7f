"""Two parameters against each other: the share of cases met, or the mean of a figure, in every cell."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.report import Cell, csv_text
from uictest.sweep.plan.plan import Plan
from uictest.sweep.summaries.bins import ParameterBins

if TYPE_CHECKING:
    import pyarrow as pa

MET: Final = "met"
"""Name of the map of verdicts."""


class MapSums:
    """Sums over the cases of each cell, taken part by part."""

    def __init__(self, plan: Plan, rows: ParameterBins, columns: ParameterBins, measure: str) -> None:
        self.rows, self.columns, self.measure = rows, columns, measure
        self._plan = plan
        shape = (len(rows.labels), len(columns.labels))
        self._sum, self._known = np.zeros(shape), np.zeros(shape, np.int64)
        self._met, self._cases = np.zeros(shape, np.int64), np.zeros(shape, np.int64)

    def take(self, table: pa.Table) -> None:
        """Add the rows of a part; a case without the figure has no part in its mean."""
        indices = table.column("index").to_numpy()
        values = np.array(table.column(self.measure).to_numpy(zero_copy_only=False), float)
        known = np.isfinite(values)
        down, across = (each.of(self._plan, indices, table) for each in (self.rows, self.columns))
        np.add.at(self._sum, (down[known], across[known]), values[known])
        np.add.at(self._known, (down[known], across[known]), 1)
        np.add.at(self._met, (down, across), np.array(table.column(MET).to_pylist(), bool))
        np.add.at(self._cases, (down, across), 1)

    def sums(self) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """Return the sum of each cell and how many cases have the figure, shape (rows, columns) both."""
        return self._sum, self._known

    def means(self) -> NDArray[np.float64]:
        """Return the mean of each cell, shape (rows, columns); NaN where no case has the figure."""
        return mean_of(self._sum, self._known)

    def counts(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return the cases met and all cases of each cell, shape (rows, columns) both."""
        return self._met, self._cases

    def csv(self) -> str:
        """Return the map as CSV: a line per value of the first parameter, a column per value of the other."""
        corner = f"{self.rows.key} \\ {self.columns.key}"
        names = [corner, *self.columns.labels]
        return csv_text(names, self._csv_rows(names))

    def _csv_rows(self, names: Sequence[str]) -> Iterator[dict[str, Cell]]:
        for label, means in zip(self.rows.labels, self.means().tolist(), strict=True):
            yield dict(zip(names, [label, *means], strict=True))


def mean_of(sums: NDArray[np.float64], cases: NDArray[Any]) -> NDArray[np.float64]:
    """Return sums divided by their numbers of cases; NaN where there is none."""
    means = np.full(sums.shape, np.nan)
    np.divide(sums, cases, out=means, where=cases > 0)
    return means
