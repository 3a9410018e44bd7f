"""Axes of swept parameters: linear, or logarithmic where the values were spaced or drawn so."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from uictest.report.page.axis import Axis, Tick, span


@dataclass(frozen=True, slots=True)
class NumberAxis:
    """Numbers from `low` to `high` on pixels from `start` to `end`.

    Args:
        low: smallest number; above zero where the axis is logarithmic.
        high: largest number, above `low`.
        start: pixel of the smallest number.
        end: pixel of the largest number.
        logarithmic: equal ratios are equally long.

    """

    low: float
    high: float
    start: float
    end: float
    logarithmic: bool = False

    def at(self, value: float) -> float:
        """Return the pixel of a value, at most at the ends of the axis."""
        return self._axis.at(self._scaled(value))

    def tick_marks(self, most: int) -> list[Tick]:
        """Return at most about `most` round values: their pixels and labels."""
        values = list(self._round_values(most)) if self.logarithmic else []
        if len(values) < 3:
            # Within less than a decade there are too few round values of a logarithmic axis.
            values = [value for value, _ in Axis(self.low, self.high, 0.0, 1.0).ticks(most)]
        return [(self.at(value), f"{value:.12g}") for value in values]

    def _round_values(self, most: int) -> Iterator[float]:
        first, last = math.floor(math.log10(self.low)), math.floor(math.log10(self.high))
        factors = next(
            (each for each in ((1, 2, 5), (1, 3), (1,)) if len(each) * (last - first + 1) <= most + 1), (1,)
        )
        every = max(1, -(-(last - first + 1) // most))
        for power in range(first, last + 1, every):
            for factor in factors:
                value = float(f"{factor}e{power}")
                if self.low * (1 - 1e-9) <= value <= self.high * (1 + 1e-9):
                    yield value

    @property
    def _axis(self) -> Axis:
        return Axis(self._scaled(self.low), self._scaled(self.high), self.start, self.end)

    def _scaled(self, value: float) -> float:
        return math.log(value) if self.logarithmic else value


def spanned(values: Sequence[float], start: float, end: float, *, logarithmic: bool) -> NumberAxis:
    """Return an axis that spans values with a little air; it is linear where one is not above zero."""
    if not logarithmic or min(values) <= 0.0:
        return NumberAxis(*span([np.array(values)], ()), start, end)
    air = 0.04 * math.log(max(values) / min(values)) or math.log(2.0)
    return NumberAxis(min(values) * math.exp(-air), max(values) * math.exp(air), start, end, True)
