"""From a point that fails to the smallest one: without faults, with values that are nominal or round."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import permutations
from typing import ClassVar, Final, NamedTuple

from uictest.plans.search import NOMINAL, Axis, Point
from uictest.searching.trials import REFUSED, Stop, Trials

_STEPS: Final = (5.0, 2.0, 1.0)
"""Round numbers are multiples of these and a power of ten."""


class Neighbour(NamedTuple):
    """A value beside that of a found case: how many of the stops fail with it."""

    text: str
    failing: int


@dataclass(frozen=True)
class Shrinking:
    """Makes a point that fails smaller; every step is run under all seeds, as a file with its values is.

    Args:
        trials: runs the stops.
        target: criterion that fails, or ERROR.

    """

    shares_of_size: ClassVar[tuple[float, ...]] = (0.1, 0.25, 0.5, 0.7, 0.85)
    """Of the size of a fault, tried in turn to make it smaller; chosen."""
    farther: ClassVar[tuple[float, ...]] = (0.75, 1.25, 0.5, 1.5, 2.0)
    """Factors on the distance of the value that matters from where it does nothing; chosen."""

    moved: ClassVar[tuple[float, ...]] = (0.8, 0.9, 1.1, 1.25)
    """Factors on the distance from nominal of one value while another becomes nominal; chosen."""

    trials: Trials
    target: str

    def smallest(self, point: Point) -> Point:
        """Return the smallest point that still fails."""
        before: Point = ()
        while point != before:
            before = point
            failing = (each for each in self._simpler(point) if each != point and self.fails(each))
            point = next(failing, point)
        for axes in self.trials.space.faults:
            point = self._with_smaller_size(point, axes.first + 3)
        for column in range(len(point)):
            point = self._rounded(point, column)
        return point

    def failing(self, point: Point) -> int:
        """Return in how many stops under different seeds a point fails; 0 where one cannot be run.

        Where all of the first stops pass, and so many that it cannot be found any more, that is 0, too.
        """
        needed, stops = self.trials.space.search.fails_in
        index, failing = self.trials.targets.index(self.target), 0
        for seeds in (range(stops - needed + 1), range(stops - needed + 1, stops)):
            trials = self.trials.run(Stop(point, seed, own_noise=True) for seed in seeds)
            failing += sum(trial.margins[index] < 0.0 for trial in trials)
            if failing == 0 or any(trial.outcome == REFUSED for trial in trials):
                return 0
        return failing

    def fails(self, point: Point) -> bool:
        """Return whether a point fails in as many stops as the search asks for."""
        return self.failing(point) >= self.trials.space.search.fails_in.needed

    def neighbours(self, point: Point) -> tuple[Neighbour, ...]:
        """Return values below and above the one that matters with which the point passes, as far as found."""
        column = self.telling_column(point)
        if column is None:
            return ()
        axis = self._axis(point, column)
        centre = axis.nominal if axis.origin is None else axis.origin
        centre = axis.low if math.isnan(centre) else centre
        value = axis.number(point[column])
        sides: dict[bool, Neighbour] = {}
        for factor in self.farther:
            text = axis.text(_with_digits(centre + factor * (value - centre), 3))
            is_above = axis.number(text) > value
            if is_above in sides or text == point[column]:
                continue
            failing = self.failing(_with(point, self._columns_alike(point, column), text))
            if failing < self.trials.space.search.fails_in.needed:
                sides[is_above] = Neighbour(text, failing)
        return tuple(sides[side] for side in sorted(sides))

    def telling_column(self, point: Point) -> int | None:
        """Return the column whose value matters: the size of a fault, else the first number off nominal."""
        space = self.trials.space
        sizes = [axes.first + 3 for axes in space.faults if point[axes.first + 3] != NOMINAL]
        numbers = [column for column in range(len(space.axes)) if point[column] != NOMINAL]
        return next(iter((*sizes, *numbers)), None)

    def _simpler(self, point: Point) -> Iterator[Point]:
        """Yield points with fewer values off nominal: without a fault, the profile as one, single numbers."""
        space = self.trials.space
        for axes in space.faults:
            yield _with(point, range(axes.first, axes.first + 4), NOMINAL)
        if profile := space.profile:
            yield _with(point, profile, NOMINAL)
            if len({point[column] for column in profile}) > 1:
                for text in sorted({point[column] for column in profile} - {NOMINAL}):
                    yield _with(point, profile, text)
        columns = (*range(len(space.axes)), *(axes.first + k for axes in space.faults for k in (2, 3)))
        for column in columns:
            is_optional = column < len(space.axes) or point[column - 1 : column] != (NOMINAL,)
            if point[column] != NOMINAL and is_optional:
                yield _with(point, [column], NOMINAL)
        yield from self._with_another_in_its_place(point)

    def _with_another_in_its_place(self, point: Point) -> Iterator[Point]:
        """Yield points with one number less off nominal, for which another one is moved."""
        axes = self.trials.space.axes
        changed = [column for column in range(len(axes)) if point[column] != NOMINAL]
        for column, other in permutations(changed, 2):
            axis = axes[other]
            for factor in () if math.isnan(axis.nominal) else self.moved:
                text = axis.text(axis.nominal + factor * (axis.number(point[other]) - axis.nominal))
                yield _with(_with(point, [column], NOMINAL), [other], text)

    def _with_smaller_size(self, point: Point, column: int) -> Point:
        """Return the point with the size of a fault nearest to what changes nothing, while it fails."""
        if point[column] == NOMINAL or (origin := self._axis(point, column).origin) is None:
            return point
        axis = self._axis(point, column)
        for share in self.shares_of_size:
            text = axis.text(_with_digits(origin + share * (axis.number(point[column]) - origin), 2))
            smaller = _with(point, [column], text)
            if smaller != point and self.fails(smaller):
                return self._with_smaller_size(smaller, column)
        return point

    def _rounded(self, point: Point, column: int) -> Point:
        """Return the point with the roundest number in a column with which it still fails."""
        if point[column] == NOMINAL or not self._has_number(column):
            return point
        axis = self._axis(point, column)
        value = axis.number(point[column])
        power = math.floor(math.log10(axis.high - axis.low))
        for exponent in range(power, power - 5, -1):
            for step in _STEPS:
                unit = step * 10.0**exponent
                text = axis.text(round(value / unit) * unit)
                if text == point[column]:
                    return point
                rounded = _with(point, self._columns_alike(point, column), text)
                if self.fails(rounded):
                    return rounded
        return point

    def _columns_alike(self, point: Point, column: int) -> list[int]:
        """Return the columns that change together: those of a profile that is the same all along."""
        profile = self.trials.space.profile
        if column in profile and len({point[each] for each in profile}) == 1:
            return list(profile)
        return [column]

    def _has_number(self, column: int) -> bool:
        """Return whether a column holds numbers: not the kind of a fault or its wheelset."""
        return all(column not in (axes.first, axes.first + 1) for axes in self.trials.space.faults)

    def _axis(self, point: Point, column: int) -> Axis:
        for axes in self.trials.space.faults:
            if column == axes.first + 2:
                return axes.begin
            if column == axes.first + 3:
                return axes.size_axis(point[axes.first])
        return self.trials.space.axes[column]


def _with(point: Point, columns: Iterable[int], text: str) -> Point:
    changed = set(columns)
    return tuple(text if column in changed else own for column, own in enumerate(point))


def _with_digits(number: float, digits: int) -> float:
    return float(f"{number:.{digits}g}")
