"""The smallest and the largest draws of a measure, kept while the others pass by."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

Values = NDArray[np.float64]
_FEWEST_NEW: Final = 512
"""New values that are sorted in together, at least: doing so for a few at a time would take longer."""


class SmallestValues:
    """The smallest of all values that were added, so many of them; holds at most about twice as many."""

    def __init__(self, count: int) -> None:
        self._count = count
        self._kept: Values = np.zeros(0)
        """In rising order."""
        self._new: list[Values] = []
        self._new_size = 0
        self._limit = np.inf
        """Values from here on are not among the smallest."""

    def add(self, values: Values) -> None:
        """Consider further values."""
        candidates = values[values < self._limit]
        if self._count and candidates.size:
            self._new.append(candidates)
            self._new_size += candidates.size
            if self._new_size > max(self._count, _FEWEST_NEW):
                self._merge()

    def of_rank(self, rank: int) -> float | None:
        """Return the value of a rank, 1 for the smallest; None where there are fewer values.

        Raises IndexError for a rank beyond the number to keep.
        """
        if rank > self._count:
            raise IndexError(f"rank {rank} of the {self._count} smallest values")
        if self._new:
            self._merge()
        return float(self._kept[rank - 1]) if 1 <= rank <= self._kept.size else None

    def _merge(self) -> None:
        values = np.sort(np.concatenate([self._kept, *self._new]))
        self._new, self._new_size = [], 0
        self._kept = values[: self._count]
        if self._kept.size == self._count:
            self._limit = float(self._kept[-1])


class RankedDraws:
    """Draws of one measure, of which ranks from both ends are requested afterwards.

    Memory grows with the ranks, not with the draws: 16 bytes for each rank between an end and the innermost
    rank, so that a bound far out on a tail takes little and the median of ten million draws 160 MB.
    """

    def __init__(self, from_smallest: int, from_largest: int) -> None:
        """Keep the draws of these and of all outer ranks."""
        self._smallest, self._largest = SmallestValues(from_smallest), SmallestValues(from_largest)
        self.draws = 0
        self.without_value = 0

    def add(self, values: Values) -> None:
        """Add draws; one that is not a finite number is one without a value."""
        known = values[np.isfinite(values)]
        self.draws += values.size
        self.without_value += values.size - known.size
        self._smallest.add(known)
        self._largest.add(-known)

    def lower(self, rank: int | None) -> float | None:
        """Return the draw of a rank from the smallest, draws without a value taken for the smallest.

        None where the rank is None or falls on a draw without a value.
        """
        return None if rank is None else self._smallest.of_rank(rank - self.without_value)

    def upper(self, rank: int | None) -> float | None:
        """Return the draw of a rank from the largest, draws without a value taken for the largest."""
        value = None if rank is None else self._largest.of_rank(rank - self.without_value)
        return None if value is None else -value
