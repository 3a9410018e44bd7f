"""Fewer samples of a series, with every peak of it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Samples = NDArray[np.float64]
Rows = NDArray[np.intp]


def extremes(columns: Samples, y: Samples) -> Rows:
    """Return the rows that hold the smallest and the largest y of every column, in their order.

    Args:
        columns: the column of each sample, never falling; shape (n,), n > 0.
        y: samples, shape (n,). Of a column with missing samples (NaN) one of these is kept, too: a line
            through the rows has its gap there.

    """
    starts = np.flatnonzero(np.diff(columns, prepend=columns[0] - 1))
    lasts = np.append(starts[1:], len(columns)) - 1
    column = np.repeat(np.arange(len(starts)), lasts - starts + 1)
    rising = np.lexsort((y, column))  # missing samples last
    falling = np.lexsort((-y, column))
    gaps = np.where(np.isnan(y[rising[lasts]]), rising[lasts], rising[starts])
    return np.unique(np.concatenate([rising[starts], falling[starts], gaps]))


def thinned(y: Samples, bins: int) -> Rows:
    """Return the rows of a series to be drawn: both ends, and the extremes of at most `bins` equal parts."""
    parts = np.arange(len(y), dtype=np.float64) // -(-len(y) // bins)
    return np.union1d(extremes(parts, y), [0, len(y) - 1])
