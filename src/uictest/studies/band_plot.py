"""A value in its band as a small drawing: the band, the range over the repeats, the value."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from uictest.studies.quantity import PaperComparison

WIDTH: Final = 170
HEIGHT: Final = 22
_MARGIN: Final = 0.12
"""Free share of the width on both sides of what is drawn."""


@dataclass(frozen=True, slots=True)
class BandPlot:
    """Places across, pixels: a side of the band without a limit ends at the edge. `low`, `high`: repeats."""

    band: tuple[float, float]
    value: float
    low: float | None
    high: float | None
    holds: bool


def band_plot(comparison: PaperComparison) -> BandPlot | None:
    """Return the drawing of a quantity; None without a band or without a value."""
    band, ours = comparison.quantity.band, comparison.ours
    if band is None or not math.isfinite(ours.value):
        return None
    limits = [limit for limit in (band.lower, band.upper) if limit is not None]
    ends = [end for end in (ours.low, ours.high) if end is not None and math.isfinite(end)]
    # Zero is a limit of its own for a share or a difference that must stay below a bound.
    natural = [0.0] if band.lower is None and ours.value >= 0.0 else []
    shown = [*limits, *ends, *natural, ours.value]
    least, span = min(shown), (max(shown) - min(shown)) or abs(ours.value) or 1.0

    def across(value: float) -> float:
        return round(WIDTH * (_MARGIN + (1.0 - 2.0 * _MARGIN) * (value - least) / span), 1)

    return BandPlot(
        band=(
            0.0 if band.lower is None else across(band.lower),
            float(WIDTH) if band.upper is None else across(band.upper),
        ),
        value=across(ours.value),
        low=across(ends[0]) if len(ends) == 2 else None,
        high=across(ends[1]) if len(ends) == 2 else None,
        holds=comparison.result == "holds",
    )
