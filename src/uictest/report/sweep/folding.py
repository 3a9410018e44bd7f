"""A map of a sweep with few rows and columns: neighbouring values share one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from uictest.report.sweep.result import SweepMap
from uictest.report.sweep.values import SweptValue

if TYPE_CHECKING:
    from numpy.typing import NDArray

MOST_SHOWN: Final = 24
"""Most rows or columns of a map that is read as a whole."""

Fold = list[range]
"""Places of the values that share a row or a column."""


@dataclass(frozen=True, slots=True)
class FoldedMap:
    """A map whose rows and columns stand for one or more neighbouring values; cells as in the map."""

    rows: list[Sequence[SweptValue]]
    columns: list[Sequence[SweptValue]]
    means: list[list[float | None]]
    met: list[list[int]]
    cases: list[list[int]]


def fold(values: int, most: int) -> Fold:
    """Return the places of so many values in at most `most` groups, all but the last of the same size."""
    size = -(-values // most)
    return [range(first, min(first + size, values)) for first in range(0, values, size)]


def is_large(sweep_map: SweepMap, most: int = MOST_SHOWN) -> bool:
    """Return whether a map has more rows or columns than `most`."""
    return any(len(axis.values) > most for axis in (sweep_map.rows, sweep_map.columns))


def folded(sweep_map: SweepMap, most_rows: int = MOST_SHOWN, most_columns: int | None = None) -> FoldedMap:
    """Return a map with at most so many rows and columns (`most_rows` of both unless stated otherwise).

    A cell that stands for several has their cases; its mean is that of the cases in all of them.
    """
    rows = fold(len(sweep_map.rows.values), most_rows)
    columns = fold(len(sweep_map.columns.values), most_columns or most_rows)
    row_values, column_values = (
        [axis.values[places.start : places.stop] for places in groups]
        for axis, groups in ((sweep_map.rows, rows), (sweep_map.columns, columns))
    )
    means, met, cases = sweep_map.means, sweep_map.met, sweep_map.cases
    if len(rows) < len(sweep_map.rows.values) or len(columns) < len(sweep_map.columns.values):
        means = _folded_means(sweep_map, rows, columns)
        met, cases = (_summed(counts, rows, columns).tolist() for counts in (met, cases))
    return FoldedMap(list(row_values), list(column_values), means, met, cases)


def _folded_means(sweep_map: SweepMap, rows: Fold, columns: Fold) -> list[list[float | None]]:
    import numpy as np

    means = np.array(sweep_map.means, float)
    known = np.where(np.isfinite(means), sweep_map.known or sweep_map.cases, 0)
    sums = _summed(np.nan_to_num(means) * known, rows, columns)
    counts = _summed(known, rows, columns)
    return [
        [total / count if count else None for total, count in zip(*row, strict=True)]
        for row in zip(sums.tolist(), counts.tolist(), strict=True)
    ]


def _summed(cells: Any, rows: Fold, columns: Fold) -> NDArray[Any]:
    import numpy as np

    by_row = np.add.reduceat(np.asarray(cells), [places.start for places in rows], axis=0)
    return np.add.reduceat(by_row, [places.start for places in columns], axis=1)


def short_label(values: Sequence[SweptValue]) -> str:
    """Return the label of the values of a row or a column, e.g. `0.10 … 0.14`."""
    first, last = values[0].label, values[-1].label
    return first if len(values) == 1 else f"{first} … {last}"
