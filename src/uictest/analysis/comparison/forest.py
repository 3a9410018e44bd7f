"""Paired differences as a forest: the mean of every quantity with its interval, in per cent, on one axis."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from uictest.analysis.comparison.paired.difference import PairedDifference, PairedGroup
from uictest.report import relative_percent
from uictest.report.page import Axis, Tick

_LEFT: Final = 260.0
_RIGHT: Final = 880.0
_TOP: Final = 6.0
_ROW: Final = 20.0
_WIDEST: Final = 200.0
"""Per cent at which the axis ends, chosen: a mean beyond it is written out."""


@dataclass(frozen=True, slots=True)
class ForestRow:
    """One quantity in pixels, with its mean in per cent where the axis does not reach it.

    `clear` where the interval leaves out 0.
    """

    name: str
    y: float
    mean: float
    low: float
    high: float
    clear: bool
    words: str


@dataclass(frozen=True, slots=True)
class Forest:
    """The rows, largest effect first, and the axis across."""

    rows: Sequence[ForestRow]
    ticks: Sequence[Tick]
    zero: float
    bottom: float


def forest(group: PairedGroup) -> Forest | None:
    """Return the drawing of a group; None where no quantity has a share of the first side."""
    shares = [(each, share) for each in group.differences if not each.is_zero and (share := _share(each))]
    if not shares:
        return None
    reach = min(max(abs(end) for _, share in shares for end in share), _WIDEST) * 1.05
    axis = Axis(-reach, reach, _LEFT, _RIGHT)
    shares.sort(key=lambda item: -abs(item[1][0]))
    rows = []
    for place, (each, (mean, low, high)) in enumerate(shares):
        words = f"{each.quantity}: {mean:+.3g} % ({low:+.3g} .. {high:+.3g})"
        x = [axis.at(end) for end in (mean, low, high)]
        y, clear = _TOP + _ROW * (place + 0.5), low > 0.0 or high < 0.0
        beyond = f", {mean:+.3g} %" if abs(mean) > reach else ""
        rows.append(ForestRow(f"{each.quantity}{beyond}", y, x[0], x[1], x[2], clear, words))
    return Forest(rows, axis.tick_marks(7), axis.at(0.0), _TOP + _ROW * len(rows))


def _share(each: PairedDifference) -> tuple[float, float, float] | None:
    """Return mean and interval in per cent of the median of the first side; None where there is no such."""
    ends = each.mean.value, each.mean.low, each.mean.high
    shares = [relative_percent(each.first, each.first + end, each.unit) for end in ends]
    mean, low, high = (math.nan if share is None else share for share in shares)
    return (mean, low, high) if math.isfinite(mean + low + high) else None
