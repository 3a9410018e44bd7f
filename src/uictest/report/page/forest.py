"""Effects as a forest: the mean of every quantity with its interval, in per cent, on one axis."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

from uictest.report.page.axis import Axis
from uictest.report.page.plot import ROW_PIXELS, Plot, Shape, dot, row_at, rows_plot

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


def forest(effects: Iterable[Effect], words: str, x_title: str) -> Plot | None:
    """Return the drawing of effects, the largest first; None where there is none.

    The mean is filled where its interval leaves out 0, and stands beside the name where the axis does not
    reach it. Wider limits are a band behind.
    """
    largest_first = sorted(effects, key=lambda each: -abs(each.mean))
    if not largest_first:
        return None
    ends = [end for each in largest_first for end in (each.mean, each.low, each.high, *(each.outer or ()))]
    reach = min(max(map(abs, ends)) or 1.0, _WIDEST) * 1.05
    axis = Axis(-reach, reach, *ROW_PIXELS)
    names = [
        f"{each.name}, {each.mean:+.3g} %" if abs(each.mean) > reach else each.name for each in largest_first
    ]
    zero = Shape("zero", f"M{axis.at(0.0):.1f} {row_at(0) - 10}V{row_at(len(names)) - 10}")
    shapes = [zero]
    for place, each in enumerate(largest_first):
        y = row_at(place)
        if each.outer is not None:
            shapes.append(Shape("outer-limits", _level(axis, *each.outer, y)))
        shapes.append(Shape("interval-line", _level(axis, each.low, each.high, y)))
        clear = " clear" if each.low > 0.0 or each.high < 0.0 else ""
        shapes.append(Shape(f"effect{clear}", dot(axis.at(each.mean), y, 4.0), each.words))
    return rows_plot(names, shapes, axis.tick_marks(7), words, x_title)


def _level(axis: Axis, first: float, last: float, y: float) -> str:
    return f"M{axis.at(first):.1f} {y}H{axis.at(last):.1f}"
