"""An axis: what it spans, where its ticks are, and where a value lies on it."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Tick = tuple[float, str]
"""Where a round value lies, in pixels, and its label."""


@dataclass(frozen=True, slots=True)
class Axis:
    """Values from `low` to `high` on pixels from `start` to `end` (upwards where `end` is smaller)."""

    low: float
    high: float
    start: float
    end: float

    def at(self, value: float) -> float:
        """Return the pixel of a value, at most at the ends of the axis."""
        inside = min(max(value, self.low), self.high)
        return self.start + (inside - self.low) * self._pixels_per_unit

    def pixels(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the pixels of values."""
        return self.start + (np.clip(values, self.low, self.high) - self.low) * self._pixels_per_unit

    def ticks(self, most: int) -> list[tuple[float, str]]:
        """Return at most about `most` round values with their labels."""
        step = round_step((self.high - self.low) / most)
        decimals = max(0, -math.floor(math.log10(step) + 1e-9))
        first, last = math.ceil(self.low / step - 1e-9), math.floor(self.high / step + 1e-9)
        return [(k * step, f"{k * step:.{decimals}f}") for k in range(first, last + 1)]

    def tick_marks(self, most: int) -> list[Tick]:
        """Return these ticks in pixels."""
        return [(self.at(value), label) for value, label in self.ticks(most)]

    @property
    def _pixels_per_unit(self) -> float:
        return (self.end - self.start) / (self.high - self.low)


def round_step(step: float) -> float:
    """Return the smallest of 1, 2, 5 times a power of ten that is not below `step` (> 0)."""
    power = 10.0 ** math.floor(math.log10(step))
    return next(factor * power for factor in (1.0, 2.0, 5.0, 10.0) if factor * power >= step * (1 - 1e-9))


def span(groups: Iterable[NDArray[np.float64]], include: Iterable[float]) -> tuple[float, float]:
    """Return what an axis must span: all finite values, and those to be included, with a little air."""
    values = [np.asarray(list(include), dtype=np.float64), *groups]
    finite = np.concatenate([group[np.isfinite(group)] for group in values])
    low, high = (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 1.0)
    if high <= low:
        return low, low + 1.0
    air = 0.04 * (high - low)
    return (low if low == 0.0 else low - air), high + air


def axis_title(name: str, unit: str) -> str:
    """Return the title of an axis: name and unit, where there is one."""
    return f"{name}, {unit}" if unit else name
