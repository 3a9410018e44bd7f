"""Marks that a plot shows besides its lines."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Literal, NamedTuple

from uictest.judging import evaluation
from uictest.report.escaping import printable
from uictest.report.verdict_sentences import quantity

Kind = Literal["limit", "mean", "window", "band", "tolerance", "instant", "point", "interval", "fault"]


class Mark(NamedTuple):
    """A mark in a plot, in the units of the plot.

    limit, mean: a level line at `y` from `x0` to `x1`. window, band, fault: everything between `x0` and `x1`.
    None where it has no end. tolerance: everything from -`y` to `y`. instant: an upright line at `x0`.
    point: the place `x0`, `y`. interval: from `x0` to `x1` in row `y` of a strip. `wheelset` is None for a
    mark of all of them, or of the train. `along` is what `x0` and `x1` count: time, s, or distance, m.
    """

    plot: str
    kind: Kind
    label: str
    x0: float | None = None
    x1: float | None = None
    y: float | None = None
    wheelset: int | None = None
    criterion: str = ""
    status: evaluation.Status = "pass"
    along: Literal["time", "distance"] = "time"


def limit_marks(
    verdict: evaluation.Verdict,
    plot: str,
    *,
    x0: float | None = None,
    x1: float | None = None,
    scale: float = 1.0,
) -> Iterator[Mark]:
    """Yield the bounds of a criterion as level lines; a plot's unit is `scale` of the criterion's."""
    for bound in (verdict.lower, verdict.upper):
        if bound is not None and math.isfinite(bound):
            yield Mark(plot, "limit", f"limit {quantity(bound, verdict.unit)}", x0, x1, bound / scale)


def misses(verdict: evaluation.Verdict, value: float) -> bool:
    """Return whether a value, in the unit of the criterion, misses its bounds.

    A criterion that fails with a margin of 0 is one whose bounds themselves do not pass.
    """
    strict = verdict.status == "fail" and verdict.margin == 0.0
    margins = [
        *([] if verdict.lower is None else [value - verdict.lower]),
        *([] if verdict.upper is None else [verdict.upper - value]),
    ]
    return any(margin < 0.0 or (strict and margin == 0.0) for margin in margins)


def instant(plot: str, x: float, label: str) -> Mark:
    """Return an upright line."""
    return Mark(plot, "instant", printable(label), x, x)


def point(plot: str, x: float, y: float, label: str, wheelset: int | None = None) -> Mark:
    """Return a marked place."""
    return Mark(plot, "point", printable(label), x, x, y, wheelset)
