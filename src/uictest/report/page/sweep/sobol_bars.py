"""Sobol' indices as bars with their confidence intervals: one drawing per measure."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Final

from uictest.report.page.axis import Axis, Tick
from uictest.report.sweep.result import MET, SobolIndex, SobolSensitivity
from uictest.report.sweep.sweep_sentences import circumstances_words, measure_words

_LEFT, _RIGHT, _TOP = 12, 470, 10
_NAME, _BAR, _GAP = 15, 10, 9
_MOST: Final = 2.0
"""An axis reaches no further than this: an index is at most 1, and a wider interval says nothing more."""


@dataclass(frozen=True, slots=True)
class IndexBar:
    """A bar from zero to an index, and the line over its interval; an arrow where that leaves the axis."""

    kind: str
    y: float
    x: float
    width: float
    low: float
    high: float
    low_is_cut_off: bool
    high_is_cut_off: bool
    label: str


@dataclass(frozen=True, slots=True)
class SobolPlot:
    """The indices of all parameters for one measure, in pixels; `names` holds each with its position."""

    title: str
    names: Sequence[tuple[float, str]]
    bars: Sequence[IndexBar]
    ticks: Sequence[Tick]
    zero: float
    bottom: float
    left: int = _LEFT
    right: int = _RIGHT
    top: int = _TOP


def sobol_plots(sensitivities: Sequence[SobolSensitivity]) -> Iterator[SobolPlot]:
    """Yield a drawing for each measure and each combination of listed values."""
    for _, group in groupby(sensitivities, key=lambda each: (each.measure, dict(each.circumstances))):
        yield _plot(list(group))


def _plot(sensitivities: Sequence[SobolSensitivity]) -> SobolPlot:
    indices = [index for each in sensitivities for index in (each.first, each.total)]
    ends = [end for index in indices for end in (index.value, index.low, index.high) if end == end]
    axis = Axis(max(min(0.0, *ends), -_MOST), min(max(1.0, *ends), _MOST), _LEFT, _RIGHT)
    height = _NAME + 2 * _BAR + _GAP
    tops = [_TOP + height * place for place in range(len(sensitivities))]
    bars = [
        _bar(kind, index, axis, top + _NAME + _BAR * place)
        for each, top in zip(sensitivities, tops, strict=True)
        for place, (kind, index) in enumerate((("alone", each.first), ("with the others", each.total)))
    ]
    names = [(top + _NAME - 4.0, each.key) for each, top in zip(sensitivities, tops, strict=True)]
    bottom = _TOP + height * len(sensitivities)
    return SobolPlot(_title(sensitivities[0]), names, bars, axis.tick_marks(6), axis.at(0.0), bottom)


def _bar(kind: str, index: SobolIndex, axis: Axis, y: float) -> IndexBar:
    first, last = sorted((axis.at(0.0), axis.at(index.value) if index.value == index.value else axis.at(0.0)))
    low, high = (axis.at(end) if end == end else first for end in (index.low, index.high))
    cut_off = (index.low < axis.low, index.high > axis.high)
    label = f"{kind}: {index.value:.2f}, 95 % confidence {index.low:.2f} to {index.high:.2f}"
    return IndexBar(kind, y, first, last - first, low, high, *cut_off, label)


def _title(sensitivity: SobolSensitivity) -> str:
    measure = "cases met" if sensitivity.measure == MET else measure_words(sensitivity.measure)
    if not sensitivity.circumstances:
        return measure
    return f"{measure}, at {circumstances_words(sensitivity.circumstances)}"
