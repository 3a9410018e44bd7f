"""Axes of swept parameters, and where the rows and columns of a heat map lie on them."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final, Literal

import numpy as np

from uictest.report.page.axis import Axis, Tick, axis_title, span
from uictest.report.sweep.map_cells import CellAxis
from uictest.report.sweep.map_text import short_label
from uictest.report.sweep.values import DrawnInterval, SweptValue


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


Spacing = Literal["linear", "logarithmic", "listed"]

_NARROWEST: Final = 0.3
"""Smallest width of a cell over the mean width on a linear or logarithmic axis: chosen, to be readable."""
_PIXELS_PER_LETTER: Final = 6.2
_LONGEST_LABEL: Final = 22
_MOST_LABELS: Final = 16


@dataclass(frozen=True, slots=True)
class PlacedCells:
    """The cells along one side in pixels.

    Args:
        title: parameter, unit, and what is special about the axis.
        spacing: of the values.
        edges: ends of the cells in pixels: one more than there are cells.
        ticks: where labels stand, and what they say.
        slanted: the labels are too long to stand side by side.

    """

    title: str
    spacing: Spacing
    edges: Sequence[float]
    ticks: Sequence[Tick]
    slanted: bool

    def span(self, place: int) -> tuple[float, float]:
        """Return the pixels of a cell, the smaller one first."""
        first, last = self.edges[place : place + 2]
        return min(first, last), max(first, last)


def placed_cells(
    axis: CellAxis, logarithmic: Collection[str], start: float, end: float, *, upright: bool = False
) -> PlacedCells:
    """Return the cells of an axis between two pixels.

    Numbers lie where they belong; texts, and numbers that would leave cells too narrow to read, are listed
    one beside the other with the same width.
    """
    is_log = axis.parameter in logarithmic
    bounds = _bounds(axis.groups, logarithmic=is_log)
    if bounds is None:
        # The first row of a list stands on top.
        return _listed(axis, *((end, start) if upright else (start, end)), upright=upright)
    numbers = NumberAxis(min(bounds), max(bounds), start, end, is_log)
    edges = list(map(numbers.at, bounds))
    ticks = [_number_tick(group, numbers) for group in axis.groups]
    if _intervals(axis.groups) or len(ticks) > _MOST_LABELS or not (upright or _fit(ticks)):
        ticks = numbers.tick_marks(7)
        ticks = ticks if upright else _apart(ticks)
    title = axis_title(axis.parameter, axis.groups[0][0].unit) + (", logarithmic" if is_log else "")
    return PlacedCells(title, "logarithmic" if is_log else "linear", edges, ticks, slanted=False)


def _listed(axis: CellAxis, start: float, end: float, *, upright: bool) -> PlacedCells:
    edges = [start + (end - start) * k / len(axis.groups) for k in range(len(axis.groups) + 1)]
    labels = [
        label if len(label) <= _LONGEST_LABEL else f"{label[: _LONGEST_LABEL - 1]}…"
        for label in map(short_label, axis.groups)
    ]
    ticks = [((edges[k] + edges[k + 1]) / 2, label) for k, label in enumerate(labels)]
    ticks = ticks[:: -(-len(ticks) // _MOST_LABELS)]
    return PlacedCells(axis.parameter, "listed", edges, ticks, slanted=not (upright or _fit(ticks)))


def label_pixels(ticks: Sequence[Tick]) -> float:
    """Return about how long the longest label is."""
    return _PIXELS_PER_LETTER * max((len(label) for _, label in ticks), default=0)


def _bounds(groups: Sequence[Sequence[SweptValue]], *, logarithmic: bool) -> list[float] | None:
    """Return the ends of the cells as numbers, None where they are listed."""
    values = [value for group in groups for value in group]
    if len({value.unit for value in values}) != 1:
        return None
    if _intervals(groups):
        return [groups[0][0].low, *(group[-1].high for group in groups)]  # type: ignore[union-attr]
    numbers = [value.number for value in values]
    if None in numbers or len(groups) < 2:
        return None
    rising = {after > before for before, after in pairwise(numbers)}  # type: ignore[operator]
    if len(rising) > 1 or len(set(numbers)) < len(numbers):
        return None
    bounds = _between_values(groups, logarithmic=logarithmic)
    scaled = list(map(math.log, bounds)) if logarithmic else bounds
    widths = [abs(after - before) for before, after in pairwise(scaled)]
    return bounds if min(widths) >= _NARROWEST * sum(widths) / len(widths) else None


def _between_values(groups: Sequence[Sequence[SweptValue]], *, logarithmic: bool) -> list[float]:
    """Return the middles between the values of neighbouring cells, and as far beyond the outer ones."""
    to, back = (math.log, math.exp) if logarithmic else (float, float)
    ends = [(to(group[0].number), to(group[-1].number)) for group in groups]  # type: ignore[arg-type]
    inner = [(before[1] + after[0]) / 2 for before, after in pairwise(ends)]
    first = ends[0][0] - (inner[0] - ends[0][1])
    last = ends[-1][1] + (ends[-1][0] - inner[-1])
    return [back(bound) for bound in (first, *inner, last)]


def _intervals(groups: Sequence[Sequence[SweptValue]]) -> bool:
    return all(isinstance(value, DrawnInterval) for group in groups for value in group)


def _number_tick(group: Sequence[SweptValue], numbers: NumberAxis) -> Tick:
    """Return where the number of a cell lies, which is its middle only on an even axis, and its label."""
    ends = group[0], group[-1]
    pixels = [numbers.at(value.number) for value in ends if value.number is not None]
    texts = [value.label.split(" ", 1)[0] for value in ends]
    return sum(pixels) / len(pixels), texts[0] if len(group) == 1 else " … ".join(texts)


def _apart(ticks: Sequence[Tick]) -> list[Tick]:
    """Return the ticks without those whose labels would touch the one before."""
    kept: list[Tick] = []
    for tick in ticks:
        if not kept or _fit([kept[-1], tick]):
            kept.append(tick)
    return kept


def _fit(ticks: Sequence[Tick]) -> bool:
    """Return whether labels side by side keep apart."""
    lengths = [len(label) * _PIXELS_PER_LETTER for _, label in ticks]
    return all(
        abs(ticks[k + 1][0] - ticks[k][0]) > (lengths[k] + lengths[k + 1]) / 2 + 5
        for k in range(len(ticks) - 1)
    )
