"""The distribution of a measure, as bars stacked by outcome."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

from uictest.report.page.axis import Axis, Tick
from uictest.report.sweep.result import MeasureHistogram

_LEFT, _RIGHT, _TOP, _BOTTOM = 46, 402, 26, 150
_GAP = 1.0
_STACKED = ("pass", "fail", "invalid", "inconclusive", "skipped", "error")
"""Outcomes from the axis upwards."""


@dataclass(frozen=True, slots=True)
class Bar:
    """The cases of one outcome in one bin, in pixels; `label` says what it holds."""

    outcome: str
    x: float
    y: float
    width: float
    height: float
    label: str


@dataclass(frozen=True, slots=True)
class HistogramPlot:
    """A distribution, drawn. `ends` has its smallest value, mean and largest value as text."""

    title: str
    unit: str
    cases: int
    ends: tuple[str, str, str]
    outcomes: Sequence[str]
    bars: Sequence[Bar]
    x_ticks: Sequence[Tick]
    y_ticks: Sequence[Tick]
    left: int = _LEFT
    right: int = _RIGHT
    top: int = _TOP
    bottom: int = _BOTTOM


def histogram_plot(histogram: MeasureHistogram) -> HistogramPlot:
    """Return a distribution as bars."""
    edges, counts = histogram.edges, histogram.counts
    tallest = max(map(sum, zip(*counts.values(), strict=True)))
    x, y = Axis(edges[0], edges[-1], _LEFT, _RIGHT), Axis(0.0, tallest, _BOTTOM, _TOP)
    return HistogramPlot(
        histogram.measure,
        "" if histogram.unit == "1" else histogram.unit,
        histogram.cases,
        (f"{histogram.minimum:.4g}", f"{histogram.mean:.4g}", f"{histogram.maximum:.4g}"),
        [outcome for outcome in _STACKED if outcome in counts],
        list(_bars(histogram, x, y)),
        x.tick_marks(6),
        [(y.at(value), label) for value, label in y.ticks(4) if value == round(value)],
    )


def _bars(histogram: MeasureHistogram, x: Axis, y: Axis) -> Iterator[Bar]:
    for place, (low, high) in enumerate(pairwise(histogram.edges)):
        below = 0
        for outcome in _STACKED:
            count = histogram.counts[outcome][place] if outcome in histogram.counts else 0
            if count:
                top, bottom = y.at(below + count), y.at(below)
                width = max(x.at(high) - x.at(low) - _GAP, 0.5)
                label = f"{low:.4g} to {high:.4g}: {count} {outcome}"
                yield Bar(outcome, x.at(low) + _GAP / 2, top, width, bottom - top, label)
                below += count
