"""Friction as a constant or in steps along the track."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def stretch_of(place: Array, breaks: Sequence[float]) -> NDArray[np.intp]:
    """Return the number of the stretch, from 0, in which each place (m) lies; `breaks` in rising order, m."""
    return np.searchsorted(np.asarray(breaks, dtype=np.float64), place, side="right")


def stretch_names(breaks: Sequence[float]) -> list[str]:
    """Return what each stretch is called, as in "from 50 m to 120 m"."""
    if not breaks:
        return ["everywhere"]
    ends = [f"{place:g} m" for place in breaks]
    inner = [f"from {a} to {b}" for a, b in pairwise(ends)]
    return [f"up to {ends[0]}", *inner, f"from {ends[-1]} on"]
