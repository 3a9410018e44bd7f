"""What a random sample says of the tails of its measures: quantiles with bounds, and K_dry."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

from uictest.judging.evaluation import OptionalNumber
from uictest.report.sweep.values import Written


@dataclass(frozen=True, slots=True, kw_only=True)
class DrawCount:
    """Number of draws, and of those without a value: no standstill, or an error.

    A draw without a value counts on the far side of every bound: below a lower one, above an upper one.
    """

    draws: int
    without_value: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Quantile:
    """A quantile and its bounds: draws themselves, None where the sample does not support them.

    Args:
        level: share of stops at or below the quantile, between 0 and 1.
        side: the bounds that are requested.
        draws_needed: fewest draws that support them.
        estimate: of the quantile itself; None, too, where a draw has no value.
        lower: the quantile is at least this.
        upper: the quantile is at most this.

    """

    level: float
    side: Literal["lower", "upper", "both"]
    draws_needed: int
    estimate: OptionalNumber
    lower: OptionalNumber
    upper: OptionalNumber

    @property
    def is_supported(self) -> bool:
        """Whether the sample gives every bound that is requested."""
        return self.lower is not None or self.upper is not None


@dataclass(frozen=True, slots=True, kw_only=True)
class MeasureQuantiles:
    """Quantiles of one measure, at values of the listed parameters; `measure` is a column, in `unit`."""

    measure: str
    unit: str
    circumstances: Mapping[str, Written]
    confidence: float
    sample: DrawCount
    quantiles: tuple[Quantile, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class KDryLevel:
    """K_dry of one emergency brake confidence level.

    Args:
        ebcl: the level, 0 to 9 (SUBSET-026, 3.13.2.2.9).
        shortfall: share of stops that may decelerate less: 0.5, 0.1, 0.01 ... 1e-9.
        draws_needed: fewest draws that support the level.
        deceleration: lower bound of its quantile, m/s2; None where the sample does not support it.
        k_dry: that bound over the nominal deceleration; None where one of them is missing.

    """

    ebcl: int
    shortfall: float
    draws_needed: int
    deceleration: OptionalNumber
    k_dry: OptionalNumber = None


@dataclass(frozen=True, slots=True, kw_only=True)
class KDry:
    """K_dry by emergency brake confidence level, at values of the listed parameters.

    Args:
        measure: column of the deceleration, m/s2.
        circumstances: the values of the listed parameters.
        nominal: nominal deceleration, m/s2; None where the nominal case has none.
        nominal_is_stated: whether the sweep file states it; else it is that of the nominal case.
        confidence: of each bound.
        sample: the draws.
        levels: from 0 on.
        sliding: draws in which a wheelset slides, as none does on dry rail.

    """

    measure: str
    circumstances: Mapping[str, Written]
    nominal: OptionalNumber
    nominal_is_stated: bool
    confidence: float
    sample: DrawCount
    levels: tuple[KDryLevel, ...]
    sliding: int = 0

    def over(self, nominal: float | None) -> KDry:
        """Return the table for a nominal deceleration, m/s2; NaN and None stand for none."""
        if nominal is None or not (math.isfinite(nominal) and nominal > 0.0):
            return replace(
                self, nominal=None, levels=tuple(replace(each, k_dry=None) for each in self.levels)
            )
        factors = [None if each.deceleration is None else each.deceleration / nominal for each in self.levels]
        levels = [replace(each, k_dry=factor) for each, factor in zip(self.levels, factors, strict=True)]
        return replace(self, nominal=nominal, levels=tuple(levels))
