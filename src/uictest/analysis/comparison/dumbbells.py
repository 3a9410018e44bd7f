"""The braking distance of every case that differs: both sides on one axis, a row for each case."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

from uictest.report import Difference
from uictest.report.page import ROW_PIXELS, Plot, Shape, dot, row_at, rows_plot, spanned

MEASURE: Final = "braking_distance_m"
MOST: Final = 40
"""Rows that are drawn, those that differ most; the table has the others. Chosen: two screens."""
_LETTERS: Final = 40
"""Of an id of a case that there is room for."""


@dataclass(frozen=True, slots=True)
class Dumbbells:
    """The rows, those that differ most first, and how many cases have none."""

    plot: Plot
    left_out: int


def dumbbells(differences: Iterable[Difference]) -> Dumbbells | None:
    """Return the drawing of the cases whose braking distance differs; None where there is none."""
    known = [
        (each.case, each.first, each.second)
        for each in differences
        if each.quantity == MEASURE and not isinstance(each.first, str) and not isinstance(each.second, str)
    ]
    known = [each for each in known if math.isfinite(each[1] + each[2])]
    if not known:
        return None
    drawn = sorted(known, key=lambda each: -abs(each[2] - each[1]))[:MOST]
    axis = spanned([end for each in drawn for end in each[1:]], *ROW_PIXELS)
    shapes = []
    for place, (case, first, second) in enumerate(drawn):
        words = f"{case}: {first:.5g} m, then {second:.5g} m ({second - first:+.4g} m)"
        x, y = (axis.at(first), axis.at(second)), row_at(place)
        shapes += [
            Shape("interval-line", f"M{x[0]:.1f} {y}H{x[1]:.1f}", words),
            Shape("effect", dot(x[0], y, 4.0), words),
            Shape("effect clear", dot(x[1], y, 4.0), words),
        ]
    names = [case if len(case) <= _LETTERS else f"…{case[1 - _LETTERS :]}" for case, _, _ in drawn]
    about = "Braking distance of A and B in each case that differs; the table of differences has the numbers"
    x_title = "braking distance, m; open: A, filled: B"
    return Dumbbells(rows_plot(names, shapes, axis.tick_marks(7), about, x_title), len(known) - len(drawn))
