"""Two parameters against each other: the share of cases met, or the mean of a figure, in every cell."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.report.csv_table import Cell, csv_text
from uictest.sweep.classes import Classes
from uictest.sweep.plan import Plan

if TYPE_CHECKING:
    import pyarrow as pa

MET: Final = "met"
"""Name of the map of verdicts."""
_MOST_SHOWN: Final = 24
"""Rows or columns that a terminal has room for; beyond that neighbours are shown together."""
_SIGNS: Final = "#123456789."


class MapOf:
    """Sums over the cases of each cell, taken part by part."""

    def __init__(self, plan: Plan, rows: Classes, columns: Classes, measure: str) -> None:
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

    def means(self) -> NDArray[np.float64]:
        """Return the mean of each cell, shape (rows, columns); NaN where no case has the figure."""
        return _mean(self._sum, self._known)

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

    def lines(self) -> Iterator[str]:
        """Yield the map for a terminal, coarser where it would be too large."""
        what = "share met (# none, 1-9 tenths, . all)" if self.measure == MET else f"mean {self.measure}"
        yield f"{what}: {self.rows.key} down, {self.columns.key} across"
        down, across = (_bundles(each.labels) for each in (self.rows, self.columns))
        sums, cases = (_bundled(each, down, across) for each in (self._sum, self._known))
        cells = [[self._shown(value) for value in row] for row in _mean(sums, cases).tolist()]
        heads = [self.columns.labels[bundle[0]] for bundle in across]
        names = [self.rows.labels[bundle[0]] for bundle in down]
        widths = [max(map(len, (head, *column))) for head, *column in zip(heads, *cells, strict=True)]
        margin = max(map(len, names))
        for name, row in (("", heads), *zip(names, cells, strict=True)):
            yield f"{name:>{margin}}  " + "  ".join(
                f"{cell:>{width}}" for cell, width in zip(row, widths, strict=True)
            )

    def _shown(self, value: float) -> str:
        if value != value:
            return ""
        if self.measure != MET:
            return f"{value:.4g}"
        # Only what is whole is shown as whole: one case of a thousand that misses must be seen.
        return _SIGNS[0 if value == 0.0 else 10 if value == 1.0 else min(max(round(10.0 * value), 1), 9)]


def _mean(sums: NDArray[np.float64], cases: NDArray[Any]) -> NDArray[np.float64]:
    means = np.full(sums.shape, np.nan)
    np.divide(sums, cases, out=means, where=cases > 0)
    return means


def _bundles(labels: Sequence[str]) -> list[list[int]]:
    size = -(-len(labels) // _MOST_SHOWN)
    places = list(range(len(labels)))
    return [places[first : first + size] for first in range(0, len(places), size)]


def _bundled(values: NDArray[Any], down: Sequence[list[int]], across: Sequence[list[int]]) -> NDArray[Any]:
    rows = np.add.reduceat(values, [bundle[0] for bundle in down], axis=0)
    return np.add.reduceat(rows, [bundle[0] for bundle in across], axis=1)
