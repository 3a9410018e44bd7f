"""A map as lines of text: neighbouring values share a row or a column where there is no room for each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.report import STRETCH
from uictest.sweep.summaries.maps import MET, MapSums, mean_of

_MOST_SHOWN: Final = 24
"""Rows or columns that a reader takes in."""
_SIGNS: Final = "#123456789."
_GAP: Final = "  "

Fold = list[range]
"""Which values stand together, as their places."""


def map_lines(grid: MapSums, width: int | None) -> Iterator[str]:
    """Yield the map in lines of at most `width` characters, None for any width.

    A row or column that stands for several values is labelled by its first and its last value.
    """
    down, across = grid.rows.labels, grid.columns.labels
    rows = fold(len(down), _MOST_SHOWN)
    for most in range(min(_MOST_SHOWN, len(across)), 0, -1):
        columns = fold(len(across), most)
        table = list(_table(grid, rows, columns))
        if width is None or max(map(len, table)) <= width or most == 1:
            break
    what = "share met (# none, 1-9 tenths, . all)" if grid.measure == MET else f"mean {grid.measure}"
    yield f"{what}: {grid.rows.key} down, {grid.columns.key} across"
    yield from _remark(grid, rows, columns)
    yield from table


def fold(values: int, most: int) -> Fold:
    """Return the places of so many values in at most `most` groups, all but the last of the same size."""
    size = -(-values // most)
    return [range(first, min(first + size, values)) for first in range(0, values, size)]


def folded_label(labels: Sequence[str]) -> str:
    """Return what stands for neighbouring values, e.g. `0.160 .. 0.165 (2 values)`."""
    if len(labels) == 1:
        return labels[0]
    ends = f"{_first(labels)}{STRETCH}{_last(labels)}"
    return ends if STRETCH in labels[0] else f"{ends} ({len(labels)} values)"


def _remark(grid: MapSums, rows: Fold, columns: Fold) -> Iterator[str]:
    folded = [
        f"{len(axis.labels)} values of {axis.key} in {len(places)} {name}"
        for axis, places, name in ((grid.rows, rows, "rows"), (grid.columns, columns, "columns"))
        if len(places) < len(axis.labels)
    ]
    if folded:
        yield f"folded: {', '.join(folded)}; map-{grid.measure}.csv has every value"


def _table(grid: MapSums, rows: Fold, columns: Fold) -> Iterator[str]:
    sums, cases = (_folded(each, rows, columns) for each in grid.sums())
    cells = [[_shown(grid.measure, mean) for mean in row] for row in mean_of(sums, cases).tolist()]
    names = [folded_label([grid.rows.labels[place] for place in places]) for places in rows]
    heads = list(zip(*(_head([grid.columns.labels[k] for k in places]) for places in columns), strict=True))
    lines = [("", head) for head in heads if any(head)] + list(zip(names, cells, strict=True))
    widths = [max(map(len, column)) for column in zip(*(row for _, row in lines), strict=True)]
    margin = max(map(len, names))
    for name, row in lines:
        line = [f"{name:>{margin}}", *(f"{cell:>{size}}" for cell, size in zip(row, widths, strict=True))]
        yield _GAP.join(line).rstrip()


def _head(labels: Sequence[str]) -> tuple[str, str]:
    """Return the two lines above a column: its first value, and its last where that is another."""
    if len(labels) == 1 and STRETCH not in labels[0]:
        return labels[0], ""
    return _first(labels), f"{STRETCH.lstrip()}{_last(labels)}"


def _first(labels: Sequence[str]) -> str:
    return labels[0].partition(STRETCH)[0]


def _last(labels: Sequence[str]) -> str:
    return labels[-1].rpartition(STRETCH)[2]


def _folded(values: NDArray[Any], rows: Fold, columns: Fold) -> NDArray[Any]:
    down = np.add.reduceat(values, [places.start for places in rows], axis=0)
    return np.add.reduceat(down, [places.start for places in columns], axis=1)


def _shown(measure: str, value: float) -> str:
    if value != value:
        return ""
    if measure != MET:
        return f"{value:.4g}"
    # Only what is whole is shown as whole: one case of a thousand that misses must be seen.
    return _SIGNS[0 if value == 0.0 else 10 if value == 1.0 else min(max(round(10.0 * value), 1), 9)]
