"""The bounds of a criterion, values against them, and which wheelset decides."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from uictest.core.units import in_unit, to_12_digits, value_text, with_unit
from uictest.plans import scenario


@dataclass(frozen=True, slots=True)
class Bounds:
    """Bounds of a value, in its unit; None: no bound. `strict`: a value at the bound does not pass."""

    lower: float | None
    upper: float | None
    strict: bool = False

    def margin(self, value: float) -> float:
        """Return the distance to the nearest bound, positive inside, negative outside; NaN for NaN."""
        if math.isnan(value):
            return math.nan
        return min(value - _or(self.lower, -math.inf), _or(self.upper, math.inf) - value)

    def hold(self, value: float) -> bool:
        """Return whether a value keeps its bounds. NaN and infinity never do."""
        return math.isfinite(value) and self._above(value) and self._below(value)

    def hold_throughout(self, low: float, high: float) -> bool | None:
        """Return whether a value that lies somewhere from `low` to `high` keeps the bounds; None: open."""
        if self._above(low) and self._below(high):
            return True
        return None if self._above(high) and self._below(low) else False

    def side(self, value: float) -> int:
        """Return -1 below the lower bound, 1 above the upper one, 0 between."""
        below = self.lower is not None and value < self.lower
        above = self.upper is not None and value > self.upper
        return int(above) - int(below)

    def _above(self, value: float) -> bool:
        return self.lower is None or (value > self.lower if self.strict else value >= self.lower)

    def _below(self, value: float) -> bool:
        return self.upper is None or (value < self.upper if self.strict else value <= self.upper)

    def demand(self, unit: str) -> str:
        """Return where a value must lie, for a reader: "within the limit of 1 s", "above 35 %"."""
        if self.lower is not None and self.upper is not None:
            return f"within the limits of {with_unit(str(self), unit)}"
        bound = value_text(_or(self.lower, _or(self.upper, math.nan)), unit)
        if self.strict:
            return f"{'below' if self.lower is None else 'above'} {bound}"
        return f"within the limit of {bound}" if self.lower is None else f"at or above {bound}"

    def __str__(self) -> str:
        """Return the bounds for a reader: ">= 35", "< 0.08", "440 .. 490"."""
        equal = "" if self.strict else "="
        if self.lower is None:
            return f"<{equal} {self.upper:.4g}"
        if self.upper is None:
            return f">{equal} {self.lower:.4g}"
        return f"{self.lower:.4g} .. {self.upper:.4g}"


def bounds_of(criterion: scenario.Criterion) -> Bounds:
    """Return the bounds of a criterion in the unit of its measure."""
    lower, upper = (
        None if bound is None else to_12_digits(in_unit(bound, criterion.unit))
        for bound in (criterion.lower, criterion.upper)
    )
    return Bounds(lower, upper, criterion.strict)


def deciding(values: Sequence[float], bounds: Bounds, needed: int) -> float:
    """Return the value that decides whether at least `needed` of the values keep the bounds.

    That is the one with the `needed`-th largest margin: it keeps the bounds if and only if `needed` do. NaN
    and infinity count as the worst of all.
    """

    def merit(value: float) -> float:
        return bounds.margin(value) if math.isfinite(value) else -math.inf

    return sorted(values, key=merit, reverse=True)[needed - 1]


def _or(bound: float | None, otherwise: float) -> float:
    return otherwise if bound is None else bound
