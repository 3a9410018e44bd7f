"""From a point that fails to the smallest one: without faults, with values that are nominal or round."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import ClassVar, Final

import numpy as np
from numpy.typing import NDArray

from uictest.plans.scenario.yaml import parse_decimal_quantity
from uictest.plans.search import NOMINAL, Point
from uictest.searching.engine import Engine
from uictest.searching.trials import Stop

_STEPS: Final = (5.0, 2.0, 1.0)
"""Round numbers are multiples of these and a power of ten."""


@dataclass(frozen=True)
class Shrinking:
    """Makes a point that fails smaller; every step is run under all seeds, as a file with its values is.

    Args:
        engine: that found the point.
        target: criterion that fails, or ERROR.

    """

    smaller: ClassVar[tuple[float, ...]] = (0.1, 0.25, 0.5, 0.7, 0.85)
    """Factors on the size of a fault, tried in turn; chosen."""
    farther: ClassVar[tuple[float, ...]] = (0.02, 0.1, 0.3)
    """Steps to the neighbours, over the size of a fault or the range of a number; chosen."""
    few: ClassVar[int] = 2
    """Values off nominal that are few enough; chosen: what a sentence says at a glance."""

    engine: Engine
    target: str

    def smallest(self, point: Point) -> Point:
        """Return the point with few values off nominal, small faults and round numbers that still fails."""
        vector = self.engine.vectors[point]
        while (simpler := next(self._with_fewer(point, vector), None)) is not None:
            point, vector = simpler, self.engine.vectors.get(simpler, vector)
        for axes in self.engine.trials.space.faults:
            column = axes.first + 3
            while (smaller := self._with_first(point, column, self._smaller_sizes(point, column))) != point:
                point = smaller
        for column in range(len(point)):
            point = self._with_first(point, column, self._round_numbers(point, column))
        return point

    def fails(self, point: Point) -> bool:
        """Return whether a point fails in as many stops as the search asks for.

        Where none of the first fails, and they are so many that it cannot any more, the others are not run.
        """
        needed, stops = self.engine.trials.space.search.fails_in
        is_possible = any(margin < 0.0 for margin in self._margins(point, stops - needed + 1))
        return is_possible and sum(margin < 0.0 for margin in self._margins(point, stops)) >= needed

    def passes(self, point: Point) -> bool:
        """Return whether a point passes in as many stops, and in so many that it cannot be found."""
        needed, stops = self.engine.trials.space.search.fails_in
        passing = sum(margin >= 0.0 for margin in self._margins(point, stops))
        return passing >= max(needed, stops - needed + 1)

    def _margins(self, point: Point, seeds: int) -> list[float]:
        trials = self.engine.trials
        run = trials.run(Stop(point, seed, own_noise=True) for seed in range(seeds))
        return [trial.margins[trials.targets.index(self.target)] for trial in run]

    def neighbours(self, point: Point) -> list[str]:
        """Return the nearest of some values below and above the one that matters with which it passes.

        The one that matters is the size of a fault, else the first number off nominal.
        """
        space = self.engine.trials.space
        sizes = [axes.first + 3 for axes in space.faults]
        column = next((k for k in (*sizes, *range(len(space.axes))) if point[k] != NOMINAL), None)
        axis = None if column is None else space.axis_of(point, column)
        if column is None or axis is None:
            return []
        value = _number(point[column])
        width = axis.high - axis.low if axis.origin is None else abs(value - axis.origin)
        neighbours = []
        for side in (-width, width):
            texts = [axis.text(float(f"{value + side * step:.3g}")) for step in self.farther]
            neighbours += [t for t in texts if self.passes(self._with_text(point, column, t))][:1]
        return neighbours

    def _with_fewer(self, point: Point, vector: NDArray[np.float64]) -> Iterator[Point]:
        """Yield points that fail with fewer values off nominal: without one as they are, then near by."""
        space, numbers = self.engine.trials.space, range(len(self.engine.trials.space.axes))
        groups = [tuple(axes.columns) for axes in space.faults] + [(column,) for column in numbers]
        changed = [group for group in groups if point[group[0]] != NOMINAL]
        of_faults = [(axes.first + k,) for axes in space.faults for k in (2, 3) if point[axes.first + k]]
        simpler = [_with(point, group, NOMINAL) for group in (tuple(space.profile), *changed, *of_faults)]
        simpler += [
            _with(point, space.profile, text) for text in dict.fromkeys(point[k] for k in space.profile)
        ]
        size = self._size(point)
        yield from (each for each in simpler if self._size(each) < size and self.fails(each))
        for group in changed if size[0] > self.few else ():
            others = [column for each in changed if each != group for column in each]
            found = self.engine.found_near(vector, others, self.target)
            yield from (each for each in found if self._size(each) < size and self.fails(each))

    def _size(self, point: Point) -> tuple[int, int]:
        """Return how many values are not nominal, and how many beside them that a fault has."""
        space = self.engine.trials.space
        of_faults = sum(point[axes.first + k] != NOMINAL for axes in space.faults for k in (2, 3))
        return space.off_nominal(point), of_faults

    def _smaller_sizes(self, point: Point, column: int) -> Iterator[str]:
        axis = self.engine.trials.space.axis_of(point, column)
        if axis is not None and axis.origin is not None:
            for factor in self.smaller:
                size = axis.origin + factor * (_number(point[column]) - axis.origin)
                yield axis.text(float(f"{size:.2g}"))

    def _round_numbers(self, point: Point, column: int) -> Iterator[str]:
        axis = self.engine.trials.space.axis_of(point, column)
        if axis is not None and point[column] != NOMINAL:
            power = math.floor(math.log10(axis.high - axis.low))
            units = (step * 10.0**exponent for exponent in range(power, power - 5, -1) for step in _STEPS)
            yield from (axis.text(round(_number(point[column]) / unit) * unit) for unit in units)

    def _with_first(self, point: Point, column: int, texts: Iterable[str]) -> Point:
        """Return the point with the first of some values with which it still fails, or as it is."""
        others = itertools.takewhile(lambda text: text != point[column], texts)
        changed = (self._with_text(point, column, text) for text in others)
        return next(filter(self.fails, changed), point)

    def _with_text(self, point: Point, column: int, text: str) -> Point:
        """Return the point with another value; a profile that is the same all along stays so."""
        profile = self.engine.trials.space.profile
        alike = column in profile and len({point[each] for each in profile}) == 1
        return _with(point, profile if alike else [column], text)


def _with(point: Point, columns: Sequence[int], text: str) -> Point:
    return tuple(text if column in columns else own for column, own in enumerate(point))


def _number(text: str) -> float:
    return float(parse_decimal_quantity(text).number)
