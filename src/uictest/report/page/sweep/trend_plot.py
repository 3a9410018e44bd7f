"""A figure over a swept parameter: a line through its means, in a band from the smallest to the largest."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from uictest.report.page.axis import Axis, Tick, span
from uictest.report.page.sweep.labels import number_in, unit_in, with_unit
from uictest.report.wording import counted

_LEFT, _RIGHT, _TOP, _BOTTOM = 52, 402, 26, 166
Pixels = tuple[float, float]


@dataclass(frozen=True, slots=True)
class TrendPoint:
    """The mean at one value, in pixels; `missed` where a case there did not meet its expectation."""

    x: float
    y: float
    label: str
    missed: bool


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
    left: int = _LEFT
    right: int = _RIGHT
    top: int = _TOP
    bottom: int = _BOTTOM


@dataclass(frozen=True, slots=True)
class _Value:
    """What a figure came to at one value of the parameter; `missed` counts those without the figure, too."""

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


def trend_plot(found: Mapping[str, Any], counts: Sequence[Mapping[str, Any]]) -> TrendPlot | None:
    """Return a trend of `sweep.json` drawn, None where its parameter has no two numbers of one unit.

    Args:
        found: the trend.
        counts: the rates of the parameter, which has a value each.
    """
    units = {unit_in(label) for label in found["values"]}
    values = sorted(_values(found, counts), key=lambda value: value.at)
    if len(units) != 1 or len({value.at for value in values}) < 2:
        return None
    x = Axis(*span([np.array([value.at for value in values])], ()), _LEFT, _RIGHT)
    reached = np.array([(value.minimum, value.maximum) for value in values])
    y = Axis(*span([reached.ravel()], ()), _BOTTOM, _TOP)
    return TrendPlot(
        with_unit(found["measure"], "" if found["unit"] == "1" else found["unit"]),
        with_unit(found["parameter"], units.pop()),
        _line((x.at(value.at), y.at(value.mean)) for value in values),
        _band(values, x, y) if any(value.cases > 1 for value in values) else "",
        [TrendPoint(x.at(v.at), y.at(v.mean), v.words, v.missed > 0) for v in values],
        x.tick_marks(6),
        y.tick_marks(5),
    )


def _values(found: Mapping[str, Any], counts: Sequence[Mapping[str, Any]]) -> Iterator[_Value]:
    """Yield the values of the parameter that are numbers and have cases with the figure."""
    lists = (found[name] for name in ("values", "cases", "minimum", "mean", "maximum"))
    for count, label, cases, *reached in zip(counts, *lists, strict=True):
        at = number_in(label)
        if at is not None and None not in reached:
            yield _Value(at, label, cases, count["cases"] - count["met"], *reached)


def _band(values: Sequence[_Value], x: Axis, y: Axis) -> str:
    there = [(x.at(value.at), y.at(value.maximum)) for value in values]
    back = [(x.at(value.at), y.at(value.minimum)) for value in reversed(values)]
    return f"{_line([*there, *back])}Z"


def _line(points: Iterable[Pixels]) -> str:
    return "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in points)
