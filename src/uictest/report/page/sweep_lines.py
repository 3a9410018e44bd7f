"""The plots of a sweep with lines: measures over a parameter, and the frontier."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from uictest.report.page.plot import (
    X_PIXELS,
    Y_PIXELS,
    Key,
    Label,
    Plot,
    Shape,
    axis_title,
    dot,
    polyline_path,
    spanned,
)
from uictest.report.sweep.result import Frontier, FrontierScan, OutcomeCount, Trend
from uictest.report.sweep.sweep_maps import CellAxis, MapCells, short_label
from uictest.report.sweep.sweep_sentences import circumstances_words, flip_words
from uictest.report.words import counted

MOST_LINES: Final = 6
"""Lines of a plot: more cannot be told apart. Chosen."""


def _key_of_lines(names: Iterable[str]) -> list[tuple[str, str]]:
    """Return the key of lines that are drawn in this order."""
    return [(f"line role-series-{number}", name) for number, name in enumerate(names, 1)]


def _line_shapes(
    number: int, points: Sequence[tuple[float, float]], words: Sequence[str], missed: Collection[int] = ()
) -> Iterator[Shape]:
    """Yield a line through points in pixels, and each of them with its words; `missed` are filled."""
    yield Shape(f"line role-series-{number}", polyline_path(points))
    for index, ((x, y), text) in enumerate(zip(points, words, strict=True)):
        if y == y:
            kind = f"point role-series-{number}{' missed' if index in missed else ''}"
            yield Shape(kind, dot(x, y), text)


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
    for second, first in ((cells.rows, cells.columns), (cells.columns, cells.rows)):
        numbers = _axis_numbers(first)
        if numbers and 2 <= len(second.groups) <= MOST_LINES and not second.is_folded:
            break
    else:
        return None
    turned = second is cells.columns
    order = np.argsort(numbers)
    counts = (cells.cases.T if turned else cells.cases)[:, order]
    x = spanned(numbers, *X_PIXELS, logarithmic=first.parameter in logarithmic)
    x_title = axis_title(first.parameter, first.groups[0][0].unit, logarithmic=x.logarithmic)
    labels = list(map(short_label, second.groups))
    values = [short_label(first.groups[k]) for k in order]
    plots = []
    for name, means_of_cells in cells.means.items():
        means = (means_of_cells.T if turned else means_of_cells)[:, order]
        if not np.isfinite(means).any():
            continue
        y = spanned(means.ravel().tolist(), *Y_PIXELS)
        shapes: list[Shape] = []
        for index, label in enumerate(labels):
            points = [(x.at(numbers[k]), y.at(mean)) for k, mean in zip(order, means[index], strict=True)]
            words = [
                f"{label}, {value}: {mean:.4g}, {counted(int(count), 'case')}"
                for value, mean, count in zip(values, means[index], counts[index], strict=True)
            ]
            shapes += _line_shapes(index + 1, points, words)
        title = axis_title(name, units.get(name, "1"))
        plot_words = f"{title} over {x_title}, by {second.parameter}"
        plots.append(Plot(title, plot_words, x_title, x.tick_marks(6), y.tick_marks(5), shapes))
    of_cases = counted(int(counts.flat[0]), "case") if len(set(counts.flat)) == 1 else ""
    return CellLines(x_title, second.parameter, of_cases, _key_of_lines(labels), plots)


def _axis_numbers(axis: CellAxis) -> list[float]:
    """Return the values of an axis; nothing where they are no numbers of one unit, or fewer than two."""
    values = [group[0].number for group in axis.groups]
    numbers = [value for value in values if value is not None]
    units = {group[0].unit for group in axis.groups}
    return numbers if len(numbers) == len(values) >= 2 and len(units) == 1 and not axis.is_folded else []


class _TrendPoint(NamedTuple):
    """A measure at one value of the parameter; `missed` counts cases without the measure, too."""

    value: float
    label: str
    cases: int
    missed: int
    minimum: float
    mean: float
    maximum: float


def trend_plot(trend: Trend, counts: Sequence[OutcomeCount], *, logarithmic: bool = False) -> Plot | None:
    """Return a line through the means of a measure, in a band from the smallest to the largest.

    None where the parameter has no two numbers of one unit. `counts` are those of its values.
    """
    units = {value.unit for value in trend.values}
    points = sorted(_trend_points(trend, counts), key=lambda point: point.value)
    if len(units) != 1 or len({point.value for point in points}) < 2:
        return None
    x = spanned([point.value for point in points], *X_PIXELS, logarithmic=logarithmic)
    y = spanned([end for point in points for end in (point.minimum, point.maximum)], *Y_PIXELS)
    shapes = []
    if any(point.cases > 1 for point in points):
        upper = [(x.at(point.value), y.at(point.maximum)) for point in points]
        lower = [(x.at(point.value), y.at(point.minimum)) for point in reversed(points)]
        shapes.append(Shape("spread", f"{polyline_path([*upper, *lower])}Z"))
    words = []
    for point in points:
        reach = f" ({point.minimum:.4g} .. {point.maximum:.4g})" if point.cases > 1 else ""
        not_met = f"; {point.missed} not met" if point.missed else ""
        words.append(f"{point.label}: {point.mean:.4g}{reach}, {counted(point.cases, 'case')}{not_met}")
    missed = [index for index, point in enumerate(points) if point.missed]
    shapes += _line_shapes(1, [(x.at(point.value), y.at(point.mean)) for point in points], words, missed)
    title = axis_title(trend.measure, trend.unit)
    x_title = axis_title(trend.parameter, units.pop(), logarithmic=x.logarithmic)
    same = len({point.cases for point in points}) == 1
    return Plot(
        f"{title}; n = {points[0].cases}" if same else title,
        f"{title} over {x_title}",
        x_title,
        x.tick_marks(6),
        y.tick_marks(5),
        shapes,
        [] if same else [Label(x.at(p.value), Y_PIXELS[1] + 10, f"n = {p.cases}") for p in points],
    )


def _trend_points(trend: Trend, counts: Sequence[OutcomeCount]) -> Iterator[_TrendPoint]:
    """Yield the values of the parameter that are numbers and have cases with the measure."""
    columns = (trend.values, trend.cases, trend.minimum, trend.mean, trend.maximum)
    for count, value, cases, minimum, mean, maximum in zip(counts, *columns, strict=True):
        number = value.number
        if number is not None and minimum is not None and mean is not None and maximum is not None:
            missed = count.cases - count.met
            yield _TrendPoint(number, value.label, cases, missed, minimum, mean, maximum)


@dataclass(frozen=True, slots=True)
class FrontierPlot:
    """Where the verdict flips; `left_out` counts the combinations that there was no room for."""

    plot: Plot
    key: Key
    left_out: int


class _DrawnFlip(NamedTuple):
    """A flip at a value of the other parameter, in the middle between two of its own, and its words."""

    value: float
    middle: float
    met_at_low: bool
    words: str


def frontier_plot(frontier: Frontier, logarithmic: Collection[str] = ()) -> FrontierPlot | None:
    """Return the frontier over the first other parameter of numbers; None where there is none.

    `logarithmic` are the keys of the parameters whose axes are.
    """
    key = _numeric_key(frontier.scans)
    if key is None:
        return None
    scanned = sorted({_circumstance_number(scan, key) for scan in frontier.scans})
    # One line for each combination of the other parameters.
    flips: dict[str, list[_DrawnFlip]] = {}
    units = []
    for scan in frontier.scans:
        others = {name: value for name, value in scan.circumstances.items() if name != key}
        combination = circumstances_words(others) if others else "the verdict flips here"
        for flip in scan.flips:
            units.append(flip.low.unit)
            if flip.low.number is not None and flip.high.number is not None:
                middle = 0.5 * (flip.low.number + flip.high.number)
                drawn = _DrawnFlip(_circumstance_number(scan, key), middle, flip.met_at_low, flip_words(flip))
                flips.setdefault(combination, []).append(drawn)
    if not flips:
        return None
    x = spanned(scanned, *X_PIXELS, logarithmic=key in logarithmic)
    middles = [drawn.middle for of_combination in flips.values() for drawn in of_combination]
    y = spanned(middles, *Y_PIXELS, logarithmic=frontier.parameter in logarithmic)
    shapes = []
    for number, of_combination in enumerate(list(flips.values())[:MOST_LINES], 1):
        # A line through the flips of one direction, with gaps where a value has none.
        path = ""
        for direction in (False, True):
            heights = {drawn.value: drawn.middle for drawn in of_combination if drawn.met_at_low == direction}
            path += polyline_path((x.at(value), y.at(heights.get(value, math.nan))) for value in scanned)
        shapes.append(Shape(f"line role-series-{number}", path))
        for drawn in sorted(of_combination, key=lambda drawn: drawn.value):
            point, words = dot(x.at(drawn.value), y.at(drawn.middle)), f"{drawn.value:g}: {drawn.words}"
            shapes.append(Shape(f"point role-series-{number}", point, words))
    x_title = axis_title(key, frontier.scans[0].circumstances[key].unit, logarithmic=x.logarithmic)
    title = axis_title(frontier.parameter, units[0], logarithmic=y.logarithmic)
    words = f"Where the verdict flips along {frontier.parameter}, over {x_title}; the table has the numbers"
    plot = Plot(title, words, x_title, x.tick_marks(6), y.tick_marks(5), shapes)
    return FrontierPlot(plot, _key_of_lines(list(flips)[:MOST_LINES]), max(len(flips) - MOST_LINES, 0))


def _numeric_key(scans: Sequence[FrontierScan]) -> str | None:
    """Return the first parameter whose values are different numbers."""
    for key in scans[0].circumstances if scans else ():
        numbers = {scan.circumstances[key].number for scan in scans}
        if None not in numbers and len(numbers) > 1:
            return key
    return None


def _circumstance_number(scan: FrontierScan, key: str) -> float:
    number = scan.circumstances[key].number
    assert number is not None  # a numeric key has numbers only
    return number
