"""Effects as a forest: the mean of every quantity with its interval, in per cent, on one axis."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Final

from uictest.report.page.axis import Axis, Tick

_LEFT: Final = 260.0
_RIGHT: Final = 880.0
_TOP: Final = 6.0
_ROW: Final = 20.0
_WIDEST: Final = 200.0
"""Per cent at which the axis ends, chosen: a mean beyond it is written out."""


@dataclass(frozen=True, slots=True)
class Effect:
    """A mean in per cent with its interval; `outer` are wider limits around it, where there are any."""

    name: str
    mean: float
    low: float
    high: float
    outer: tuple[float, float] | None = None

    @property
    def words(self) -> str:
        """The effect in words."""
        return f"{self.name}: {self.mean:+.3g} % ({self.low:+.3g} .. {self.high:+.3g})"


@dataclass(frozen=True, slots=True)
class ForestRow:
    """One effect in pixels, its name with the mean where the axis does not reach that.

    `clear` where the interval leaves out 0.
    """

    name: str
    y: float
    mean: float
    low: float
    high: float
    clear: bool
    words: str
    outer: tuple[float, float] | None = None


@dataclass(frozen=True, slots=True)
class Forest:
    """The rows, largest effect first, and the axis across."""

    rows: Sequence[ForestRow]
    ticks: Sequence[Tick]
    zero: float
    bottom: float


def forest(effects: Iterable[Effect]) -> Forest | None:
    """Return the drawing of effects; None where there is none."""
    largest_first = sorted(effects, key=lambda each: -abs(each.mean))
    if not largest_first:
        return None
    ends = [end for each in largest_first for end in (each.mean, each.low, each.high, *(each.outer or ()))]
    reach = min(max(map(abs, ends)) or 1.0, _WIDEST) * 1.05
    axis = Axis(-reach, reach, _LEFT, _RIGHT)
    rows = []
    for place, each in enumerate(largest_first):
        beyond = f", {each.mean:+.3g} %" if abs(each.mean) > reach else ""
        mean, low, high = axis.at(each.mean), axis.at(each.low), axis.at(each.high)
        outer = None if each.outer is None else (axis.at(each.outer[0]), axis.at(each.outer[1]))
        clear, y = each.low > 0.0 or each.high < 0.0, _TOP + _ROW * (place + 0.5)
        rows.append(ForestRow(f"{each.name}{beyond}", y, mean, low, high, clear, each.words, outer))
    return Forest(rows, axis.tick_marks(7), axis.at(0.0), _TOP + _ROW * len(rows))
