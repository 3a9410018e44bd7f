"""An axis: what it spans, where its ticks are, and where a value lies on it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

Tick = tuple[float, str]
"""Where a round value lies, in pixels, and its label."""
_MOST_DECIMALS: Final = 6
"""Decimals of a label; a smaller number is written with an exponent. Chosen."""


class Axis(NamedTuple):
    """Values from `low` to `high` on pixels from `start` to `end` (upwards where `end` is smaller).

    On a `logarithmic` axis, of numbers above zero, equal ratios are equally long.
    """

    low: float
    high: float
    start: float
    end: float
    logarithmic: bool = False

    def at(self, value: float) -> float:
        """Return the pixel of a value, at most at the ends of the axis."""
        inside = min(max(value, self.low), self.high)
        if self.logarithmic:
            return self.start + math.log(inside / self.low) * self._pixels_per_unit
        return self.start + (inside - self.low) * self._pixels_per_unit

    def pixels(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the pixels of values."""
        inside = np.clip(values, self.low, self.high)
        own = np.log(inside / self.low) if self.logarithmic else inside - self.low
        pixels: NDArray[np.float64] = self.start + own * self._pixels_per_unit
        return pixels

    def ticks(self, most: int) -> list[tuple[float, str]]:
        """Return at most about `most` round values with their labels."""
        values = list(self._round_values_of_decades(most)) if self.logarithmic else []
        if len(values) >= 3:
            return [(value, f"{value:.12g}") for value in values]
        # Within less than a decade there are too few round values of a logarithmic axis.
        step = round_step((self.high - self.low) / most)
        decimals = max(0, -math.floor(math.log10(step) + 1e-9))
        form = f".{decimals}f" if decimals <= _MOST_DECIMALS else ".12g"
        first, last = math.ceil(self.low / step - 1e-9), math.floor(self.high / step + 1e-9)
        return [(k * step, format(k * step, form)) for k in range(first, last + 1)]

    def tick_marks(self, most: int) -> list[Tick]:
        """Return these ticks in pixels."""
        return [(self.at(value), label) for value, label in self.ticks(most)]

    def _round_values_of_decades(self, most: int) -> Iterator[float]:
        first, last = math.floor(math.log10(self.low)), math.floor(math.log10(self.high))
        decades = last - first + 1
        factors = next((each for each in ((1, 2, 5), (1, 3)) if len(each) * decades <= most + 1), (1,))
        for power in range(first, last + 1, max(1, -(-decades // most))):
            for factor in factors:
                value = float(f"{factor}e{power}")
                if self.low * (1 - 1e-9) <= value <= self.high * (1 + 1e-9):
                    yield value

    @property
    def _pixels_per_unit(self) -> float:
        length = math.log(self.high / self.low) if self.logarithmic else self.high - self.low
        return (self.end - self.start) / length


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


def spanned(values: Sequence[float], start: float, end: float, *, logarithmic: bool = False) -> Axis:
    """Return an axis that spans values with a little air; it is linear where one is not above zero."""
    finite = [value for value in values if math.isfinite(value)]
    if not logarithmic or not finite or min(finite) <= 0.0:
        return Axis(*span([np.array(values)], ()), start, end)
    air = 0.04 * math.log(max(finite) / min(finite)) or math.log(2.0)
    return Axis(min(finite) * math.exp(-air), max(finite) * math.exp(air), start, end, True)


def axis_title(name: str, unit: str = "", *, logarithmic: bool = False) -> str:
    """Return the title of an axis: name, unit where there is one, and whether it is logarithmic."""
    return ", ".join(filter(None, (name, unit if unit != "1" else "", "logarithmic" if logarithmic else "")))
