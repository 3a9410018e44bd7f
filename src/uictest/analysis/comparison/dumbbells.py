"""The braking distance of every case that differs: both sides on one axis, a row for each case."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from uictest.report import Difference
from uictest.report.page import Axis, Tick, span

MEASURE: Final = "braking_distance_m"
MOST: Final = 40
"""Rows that are drawn, those that differ most; the table has the others. Chosen: two screens."""
_LEFT, _RIGHT, _TOP, _ROW = 320.0, 880.0, 6.0, 20.0
_LETTERS: Final = 48
"""Of an id of a case that there is room for."""


@dataclass(frozen=True, slots=True)
class Dumbbell:
    """One case in pixels: where A and B lie, and in words."""

    case: str
    y: float
    first: float
    second: float
    words: str


@dataclass(frozen=True, slots=True)
class Dumbbells:
    """The rows, those that differ most first, the axis across, and how many cases have no row."""

    rows: Sequence[Dumbbell]
    ticks: Sequence[Tick]
    bottom: float
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
    axis = Axis(*span([np.array([each[1:] for each in drawn]).ravel()], ()), _LEFT, _RIGHT)
    rows = [
        Dumbbell(
            case if len(case) <= _LETTERS else f"…{case[1 - _LETTERS :]}",
            _TOP + _ROW * (place + 0.5),
            axis.at(first),
            axis.at(second),
            f"{case}: {first:.5g} m, then {second:.5g} m ({second - first:+.4g} m)",
        )
        for place, (case, first, second) in enumerate(drawn)
    ]
    return Dumbbells(rows, axis.tick_marks(7), _TOP + _ROW * len(rows), len(known) - len(drawn))
