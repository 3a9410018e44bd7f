"""A measure over a swept parameter: a line through its means, in a band from the smallest to the largest."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from uictest.report.page.axis import Axis, Tick, axis_title, span
from uictest.report.page.sweep.cell_axis import NumberAxis, spanned
from uictest.report.sweep.result import OutcomeCount, Trend
from uictest.report.verdict_sentences import counted

_LEFT, _RIGHT, _TOP, _BOTTOM = 52, 402, 26, 166
Pixels = tuple[float, float]


@dataclass(frozen=True, slots=True)
class TrendPoint:
    """The mean at one value, in pixels, of `cases`; `missed` where a case there is not as expected."""

    x: float
    y: float
    label: str
    missed: bool
    cases: int


@dataclass(frozen=True, slots=True)
class TrendPlot:
    """A trend, drawn. `band` is empty where every value has one case only."""

    title: str
    x_title: str
    line: str
    band: str
    points: Sequence[TrendPoint]
    x_ticks: Sequence[Tick]
    y_ticks: Sequence[Tick]
    of_cases: str
    """How many cases every mean is of; empty where that differs, and each point says it."""
    left: int = _LEFT
    right: int = _RIGHT
    top: int = _TOP
    bottom: int = _BOTTOM


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


def trend_plot(
    trend: Trend, counts: Sequence[OutcomeCount], *, logarithmic: bool = False
) -> TrendPlot | None:
    """Return a trend drawn, None where its parameter has no two numbers of one unit.

    Args:
        trend: the trend.
        counts: the counts for each value of the parameter.
        logarithmic: its axis is.

    """
    units = {value.unit for value in trend.values}
    values = sorted(_values(trend, counts), key=lambda value: value.at)
    if len(units) != 1 or len({value.at for value in values}) < 2:
        return None
    x = spanned([value.at for value in values], _LEFT, _RIGHT, logarithmic=logarithmic)
    reached = np.array([(value.minimum, value.maximum) for value in values])
    y = Axis(*span([reached.ravel()], ()), _BOTTOM, _TOP)
    return TrendPlot(
        axis_title(trend.measure, "" if trend.unit == "1" else trend.unit),
        axis_title(trend.parameter, units.pop()) + (", logarithmic" if x.logarithmic else ""),
        _line((x.at(value.at), y.at(value.mean)) for value in values),
        _band(values, x, y) if any(value.cases > 1 for value in values) else "",
        [TrendPoint(x.at(v.at), y.at(v.mean), v.words, v.missed > 0, v.cases) for v in values],
        x.tick_marks(6),
        y.tick_marks(5),
        f"n = {values[0].cases}" if len({value.cases for value in values}) == 1 else "",
    )


def _values(trend: Trend, counts: Sequence[OutcomeCount]) -> Iterator[_Value]:
    """Yield the values of the parameter that are numbers and have cases with the measure."""
    columns = (trend.values, trend.cases, trend.minimum, trend.mean, trend.maximum)
    for count, value, cases, minimum, mean, maximum in zip(counts, *columns, strict=True):
        at = value.number
        if at is not None and minimum is not None and mean is not None and maximum is not None:
            yield _Value(at, value.label, cases, count.cases - count.met, minimum, mean, maximum)


def _band(values: Sequence[_Value], x: NumberAxis, y: Axis) -> str:
    there = [(x.at(value.at), y.at(value.maximum)) for value in values]
    back = [(x.at(value.at), y.at(value.minimum)) for value in reversed(values)]
    return f"{_line([*there, *back])}Z"


def _line(points: Iterable[Pixels]) -> str:
    return "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in points)
