"""The share of wet stops that meet every requirement on a stop."""

from __future__ import annotations

from uictest.core.series_measures.estimate import share_of
from uictest.core.series_measures.measure import SeriesMeasure

MEASURES = (
    SeriesMeasure(
        name="passing_share",
        kind="share",
        unit="%",
        meaning="share of the wet stops that meet every requirement on a stop",
        worse="smaller",
        values=lambda stops: [float(stop.passed) for stop in stops.wet],
        statistic=share_of,
        pooled=True,
    ),
)
