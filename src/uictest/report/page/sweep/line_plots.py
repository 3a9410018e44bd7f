"""The plots of a sweep with lines: measures over a parameter, and the frontier."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from uictest.report.counts import counted
from uictest.report.page.axis import Axis, axis_title, spanned
from uictest.report.page.plot import X_PIXELS, Y_PIXELS, Key, Label, Plot, Shape, dot, line
from uictest.report.sweep.map_cells import CellAxis, MapCells
from uictest.report.sweep.map_text import short_label
from uictest.report.sweep.result import (
    Frontier,
    FrontierScan,
    OutcomeCount,
    Trend,
)
from uictest.report.sweep.sweep_sentences import circumstances_words, flip_words

MOST_LINES: Final = 6
"""Lines of a plot: more cannot be told apart. Chosen."""


def key_of_lines(names: Iterable[str]) -> list[tuple[str, str]]:
    """Return the key of lines that are drawn in this order."""
    return [(f"line role-series-{place}", name) for place, name in enumerate(names, 1)]


@dataclass(frozen=True, slots=True)
class CellLines:
    """Every measure over one parameter, a line for each value of a second one.

    Every point is the mean of one cell of the map of both, so that none mixes cases of others.
    """

    x_title: str
    second: str
    of_cases: str
    key: Key
    plots: Sequence[Plot]


def cell_lines(cells: MapCells, units: Mapping[str, str], logarithmic: Collection[str]) -> CellLines | None:
    """Return the lines of a pair of parameters; None where neither has few enough values.

    Args:
        cells: the cells of the pair.
        units: the unit of each measure.
        logarithmic: keys of the parameters whose axes are logarithmic.

    """
    if _is_line(cells.rows) and (numbers := _numbers(cells.columns)):
        second, first, turned = cells.rows, cells.columns, False
    elif _is_line(cells.columns) and (numbers := _numbers(cells.rows)):
        second, first, turned = cells.columns, cells.rows, True
    else:
        return None
    order = np.argsort(numbers)
    counts = (cells.cases.T if turned else cells.cases)[:, order]
    x = spanned(numbers, *X_PIXELS, logarithmic=first.parameter in logarithmic)
    x_title = axis_title(first.parameter, first.groups[0][0].unit, logarithmic=x.logarithmic)
    of_cases = counted(int(counts.flat[0]), "case") if len(set(counts.flat)) == 1 else ""
    labels = list(map(short_label, second.groups))
    values = [short_label(first.groups[k]) for k in order]
    plots = []
    for name, means in cells.means.items():
        own = (means.T if turned else means)[:, order]
        if not np.isfinite(own).any():
            continue
        y = spanned(own.ravel().tolist(), *Y_PIXELS)
        shapes = [
            shape
            for place, label in enumerate(labels)
            for shape in _line_shapes(
                place + 1,
                [(x.at(numbers[k]), _pixel(y, mean)) for k, mean in zip(order, own[place], strict=True)],
                [
                    f"{label}, {value}: {mean:.4g}, {counted(int(count), 'case')}"
                    for value, mean, count in zip(values, own[place], counts[place], strict=True)
                ],
            )
        ]
        title = axis_title(name, units.get(name, "1"))
        words = f"{title} over {x_title}, by {second.parameter}"
        plots.append(Plot(title, words, x_title, x.tick_marks(6), y.tick_marks(5), shapes))
    return CellLines(x_title, second.parameter, of_cases, key_of_lines(labels), plots)


def _is_line(axis: CellAxis) -> bool:
    return 2 <= len(axis.groups) <= MOST_LINES and not axis.is_folded


def _numbers(axis: CellAxis) -> list[float]:
    """Return the values of an axis; nothing where they are no numbers of one unit, or fewer than two."""
    values = [group[0].number for group in axis.groups]
    known = [value for value in values if value is not None]
    units = {group[0].unit for group in axis.groups}
    return known if len(known) == len(values) >= 2 and len(units) == 1 and not axis.is_folded else []


def _pixel(axis: Axis, value: float) -> float:
    return axis.at(value) if value == value else math.nan


def _line_shapes(
    series: int, points: Sequence[tuple[float, float]], words: Sequence[str], missed: Sequence[bool] = ()
) -> Iterator[Shape]:
    """Yield a line of this number through points in pixels, and each of them with its words."""
    yield Shape(f"line role-series-{series}", line(points))
    for place, ((x, y), text) in enumerate(zip(points, words, strict=True)):
        if y == y:
            kind = " missed" if missed and missed[place] else ""
            yield Shape(f"point role-series-{series}{kind}", dot(x, y), text)


@dataclass(frozen=True, slots=True)
class _Value:
    """A measure at one value of the parameter; `missed` counts cases without the measure, too."""

    at: float
    label: str
    cases: int
    missed: int
    minimum: float
    mean: float
    maximum: float

    @property
    def words(self) -> str:
        reach = f" ({self.minimum:.4g} .. {self.maximum:.4g})" if self.cases > 1 else ""
        missed = f"; {self.missed} not met" if self.missed else ""
        return f"{self.label}: {self.mean:.4g}{reach}, {counted(self.cases, 'case')}{missed}"


def trend_plot(trend: Trend, counts: Sequence[OutcomeCount], *, logarithmic: bool = False) -> Plot | None:
    """Return a line through the means of a measure, in a band from the smallest to the largest.

    None where the parameter has no two numbers of one unit. `counts` are those of its values.
    """
    units = {value.unit for value in trend.values}
    values = sorted(_values(trend, counts), key=lambda value: value.at)
    if len(units) != 1 or len({value.at for value in values}) < 2:
        return None
    x = spanned([value.at for value in values], *X_PIXELS, logarithmic=logarithmic)
    y = spanned([end for value in values for end in (value.minimum, value.maximum)], *Y_PIXELS)
    title = axis_title(trend.measure, trend.unit)
    x_title = axis_title(trend.parameter, units.pop(), logarithmic=x.logarithmic)
    points = [(x.at(value.at), y.at(value.mean)) for value in values]
    texts, missed = [value.words for value in values], [value.missed > 0 for value in values]
    same = len({value.cases for value in values}) == 1
    return Plot(
        f"{title}; n = {values[0].cases}" if same else title,
        f"{title} over {x_title}",
        x_title,
        x.tick_marks(6),
        y.tick_marks(5),
        [*_band(values, x, y), *_line_shapes(1, points, texts, missed)],
        [] if same else [Label(x.at(v.at), Y_PIXELS[1] + 10, f"n = {v.cases}") for v in values],
    )


def _values(trend: Trend, counts: Sequence[OutcomeCount]) -> Iterator[_Value]:
    """Yield the values of the parameter that are numbers and have cases with the measure."""
    columns = (trend.values, trend.cases, trend.minimum, trend.mean, trend.maximum)
    for count, value, cases, minimum, mean, maximum in zip(counts, *columns, strict=True):
        at = value.number
        if at is not None and minimum is not None and mean is not None and maximum is not None:
            yield _Value(at, value.label, cases, count.cases - count.met, minimum, mean, maximum)


def _band(values: Sequence[_Value], x: Axis, y: Axis) -> Iterator[Shape]:
    if any(value.cases > 1 for value in values):
        there = [(x.at(value.at), y.at(value.maximum)) for value in values]
        back = [(x.at(value.at), y.at(value.minimum)) for value in reversed(values)]
        yield Shape("spread", f"{line([*there, *back])}Z")


@dataclass(frozen=True, slots=True)
class FrontierPlot:
    """Where the verdict flips; `left_out` counts the combinations that there was no room for."""

    plot: Plot
    key: Key
    left_out: int


def frontier_plot(frontier: Frontier, logarithmic: Collection[str] = ()) -> FrontierPlot | None:
    """Return the frontier over the first other parameter of numbers; None where there is none.

    `logarithmic` are the keys of the parameters whose axes are.
    """
    key = _numeric_key(frontier.scans)
    if key is None or not any(scan.flips for scan in frontier.scans):
        return None
    scanned = sorted({_at(scan, key) for scan in frontier.scans})
    flips = [flip for scan in frontier.scans for flip in _flips(scan, key)]
    if not flips:
        return None
    x = spanned(scanned, *X_PIXELS, logarithmic=key in logarithmic)
    y = spanned([flip.middle for flip in flips], *Y_PIXELS, logarithmic=frontier.parameter in logarithmic)
    unit = next(scan.circumstances[key].unit for scan in frontier.scans)
    own_unit = next(flip.low.unit for scan in frontier.scans for flip in scan.flips)
    x_title = axis_title(key, unit, logarithmic=x.logarithmic)
    title = axis_title(frontier.parameter, own_unit, logarithmic=y.logarithmic)
    names = list(dict.fromkeys(flip.series for flip in flips))
    shapes = [
        shape
        for number, name in enumerate(names[:MOST_LINES], 1)
        for shape in _frontier_shapes(number, [flip for flip in flips if flip.series == name], scanned, x, y)
    ]
    words = f"Where the verdict flips along {frontier.parameter}, over {x_title}; the table has the numbers"
    plot = Plot(title, words, x_title, x.tick_marks(6), y.tick_marks(5), shapes)
    return FrontierPlot(plot, key_of_lines(names[:MOST_LINES]), max(len(names) - MOST_LINES, 0))


@dataclass(frozen=True, slots=True)
class _Flip:
    """A flip on both axes, the other parameters that it belongs to, its direction, and its words."""

    at: float
    middle: float
    series: str
    met_at_low: bool
    words: str


def _flips(scan: FrontierScan, key: str) -> Iterator[_Flip]:
    fixed = {name: value for name, value in scan.circumstances.items() if name != key}
    others = circumstances_words(fixed) if fixed else "the verdict flips here"
    for flip in scan.flips:
        low, high = flip.low.number, flip.high.number
        if low is not None and high is not None:
            yield _Flip(_at(scan, key), 0.5 * (low + high), others, flip.met_at_low, flip_words(flip))


def _at(scan: FrontierScan, key: str) -> float:
    number = scan.circumstances[key].number
    assert number is not None  # a numeric key has numbers only
    return number


def _frontier_shapes(
    series: int, flips: Sequence[_Flip], scanned: Sequence[float], x: Axis, y: Axis
) -> Iterator[Shape]:
    """Yield a line through flips of one direction, with gaps where a value has none, and every flip."""
    paths = []
    for direction in (False, True):
        middles = {flip.at: flip.middle for flip in flips if flip.met_at_low == direction}
        paths.append(line((x.at(at), _pixel(y, middles.get(at, math.nan))) for at in scanned))
    yield Shape(f"line role-series-{series}", "".join(paths))
    for flip in sorted(flips, key=lambda flip: flip.at):
        words = f"{flip.at:g}: {flip.words}"
        yield Shape(f"point role-series-{series}", dot(x.at(flip.at), y.at(flip.middle)), words)


def _numeric_key(scans: Sequence[FrontierScan]) -> str | None:
    """Return the first parameter whose values are different numbers."""
    for key in scans[0].circumstances if scans else ():
        numbers = {scan.circumstances[key].number for scan in scans}
        if None not in numbers and len(numbers) > 1:
            return key
    return None
