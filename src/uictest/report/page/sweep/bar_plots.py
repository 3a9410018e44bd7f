"""The plots of a sweep with bars: distributions, and Sobol' indices."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import groupby, pairwise
from typing import Final

from uictest.report.counts import counted
from uictest.report.page.axis import Axis, axis_title
from uictest.report.page.plot import X_PIXELS, Y_PIXELS, Key, Label, Plot, Shape, box
from uictest.report.sweep.result import (
    MET,
    MeasureHistogram,
    SobolIndex,
    SobolSensitivity,
    SweepResult,
)
from uictest.report.sweep.sweep_sentences import circumstances_words, measure_words
from uictest.report.sweep.tail_tables import bound_text, k_dry_text, share_text
from uictest.report.verdict_sentences import number

STACKED: Final = ("pass", "fail", "invalid", "inconclusive", "skipped", "error")
"""Outcomes from the axis upwards."""


def is_spread(histogram: MeasureHistogram) -> bool:
    """Return whether a measure has more than one value: one bar would show nothing."""
    return histogram.maximum > histogram.minimum


def histogram_plot(histogram: MeasureHistogram, result: SweepResult) -> Plot:
    """Return a distribution as bars stacked by outcome, with the quantiles that the sweep asked for."""
    edges, counts = histogram.edges, histogram.counts
    tallest = max(map(sum, zip(*counts.values(), strict=True)))
    x, y = Axis(edges[0], edges[-1], *X_PIXELS), Axis(0.0, tallest, *Y_PIXELS)
    shapes = []
    for place, (low, high) in enumerate(pairwise(edges)):
        below = 0
        for outcome in STACKED:
            if count := counts[outcome][place] if outcome in counts else 0:
                width = (x.at(low) + 0.5, max(x.at(high) - 0.5, x.at(low) + 1.0))
                words = f"{low:.4g} to {high:.4g}: {count} {outcome}"
                shapes.append(Shape(f"bar-{outcome}", box(width, (y.at(below), y.at(below + count))), words))
                below += count
    ends = [f"{value:.4g}" for value in (histogram.minimum, histogram.mean, histogram.maximum)]
    title = axis_title(histogram.measure, histogram.unit)
    cases = counted(histogram.cases, "case")
    lines, labels = _tail_shapes(histogram, result, x)
    return Plot(
        title,
        f"{title} of {cases}: from {ends[0]} to {ends[2]}, mean {ends[1]}",
        "",
        x.tick_marks(6),
        [(y.at(value), label) for value, label in y.ticks(4) if value == round(value)],
        [*shapes, *lines],
        labels,
        f"{ends[0]} to {ends[2]}, mean {ends[1]}; {cases}",
    )


def _tail_shapes(
    histogram: MeasureHistogram, result: SweepResult, x: Axis
) -> tuple[list[Shape], list[Label]]:
    """Return lines at the quantiles, or else at the bounds, of a measure, and their levels above them."""
    shapes: list[Shape] = []
    labels: list[Label] = []
    taken = -math.inf
    for at, level, words in sorted(_tails(histogram, result)):
        shapes.append(Shape("quantile", f"M{x.at(at):.1f} {Y_PIXELS[0]}V{Y_PIXELS[1]}", words))
        if x.at(at) - taken > 30:
            labels.append(Label(x.at(at), Y_PIXELS[1] + 8, level, "mark middle"))
            taken = x.at(at)
    return shapes, labels


def _tails(histogram: MeasureHistogram, result: SweepResult) -> Iterator[tuple[float, str, str]]:
    """Yield where the tails of a measure lie that hold for all its draws, their level, and their words."""
    for table in result.quantiles:
        if (table.measure,) == histogram.columns and not table.circumstances:
            for each in table.quantiles:
                at = each.estimate if each.estimate is not None else each.upper or each.lower
                if at is not None:
                    bound = f", bound {bound_text(each)}" if each.is_supported else ", no bound"
                    yield at, share_text(each.level), f"{share_text(each.level)}: {number(at)}{bound}"
    for k_dry in result.k_dry:
        if (k_dry.measure,) == histogram.columns and not k_dry.circumstances:
            for level in k_dry.levels:
                if level.deceleration is not None:
                    factor = "" if level.k_dry is None else f", K_dry {k_dry_text(level.k_dry)}"
                    words = f"EBCL {level.ebcl}: at least {number(level.deceleration)}{factor}"
                    yield level.deceleration, f"EBCL {level.ebcl}", words


_WIDEST: Final = 2.0
"""An axis reaches no further than this: an index is at most 1, and a wider interval says nothing more."""
SOBOL_KEY: Final[Key] = (("index alone", "alone"), ("index together", "with the others"))
_INDEX_ROW: Final = 34.0
"""Height of the two bars of a parameter and its name, px; chosen."""


def sobol_plots(sensitivities: Sequence[SobolSensitivity]) -> Iterator[Plot]:
    """Yield the indices of each measure, at each combination of listed values, with their intervals."""
    for _, group in groupby(sensitivities, key=lambda each: (each.measure, dict(each.circumstances))):
        own = list(group)
        indices = [index for each in own for index in (each.first, each.total)]
        ends = [end for index in indices for end in (index.value, index.low, index.high) if end == end]
        left = 12.0
        x = Axis(max(min(0.0, *ends), -_WIDEST), min(max(1.0, *ends), _WIDEST), left, X_PIXELS[1])
        top = Y_PIXELS[1]
        bottom = top + _INDEX_ROW * len(own)
        shapes = [Shape("zero", f"M{x.at(0.0):.1f} {top}V{bottom}")]
        for place, each in enumerate(own):
            for kind, index, below in (("alone", each.first, 18.0), ("together", each.total, 28.0)):
                shapes += _index_shapes(kind, index, x, top + _INDEX_ROW * place + below)
        names = [
            Label(x.at(0.0) + 4, top + _INDEX_ROW * place + 11, each.key, "index-name")
            for place, each in enumerate(own)
        ]
        title = _sobol_title(own[0])
        words = f"Sobol indices of {title}; the table has the numbers"
        across = (left, X_PIXELS[1])
        yield Plot(title, words, "", x.tick_marks(6), [], shapes, names, across=across, up=(bottom, top))


def _index_shapes(kind: str, index: SobolIndex, x: Axis, y: float) -> Iterator[Shape]:
    """Yield a bar up to an index, and its interval with an arrow where it leaves the axis."""
    if index.value != index.value:
        return
    name = "alone" if kind == "alone" else "with the others"
    words = f"{name}: {index.value:.2f}, 95 % confidence {index.low:.2f} to {index.high:.2f}"
    yield Shape(f"index {kind}", f"M{x.at(0.0):.1f} {y}H{x.at(index.value):.1f}", words)
    if index.low == index.low and index.high == index.high:
        first = "m5 0l-5 3l5 3m-5 -3" if index.low < x.low else "v6m0 -3"
        last = "m-5 -3l5 3l-5 3" if index.high > x.high else "m0 -3v6"
        path = f"M{x.at(index.low):.1f} {y - 3}{first}H{x.at(index.high):.1f}{last}"
        yield Shape("interval-line", path, words)


def _sobol_title(sensitivity: SobolSensitivity) -> str:
    measure = "cases met" if sensitivity.measure == MET else measure_words(sensitivity.measure)
    if not sensitivity.circumstances:
        return measure
    return f"{measure}, at {circumstances_words(sensitivity.circumstances)}"
