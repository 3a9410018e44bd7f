"""The braking distance of the wet stops, and by how much it exceeds that of the dry ones."""

from __future__ import annotations

from uictest.core.series_measures.estimate import largest_of, median_of
from uictest.core.series_measures.measure import (
    SeriesMeasure,
    SpeedStops,
    median_and_worst,
    of_stop,
    percent_of_dry,
)

BRAKING_DISTANCE = of_stop("braking_distance_m")


def extensions(stops: SpeedStops) -> list[float]:
    """Return by how much (%) the braking distance of every wet stop exceeds the mean of the dry ones."""
    return [percent - 100.0 for percent in percent_of_dry(BRAKING_DISTANCE, stops)]


MEASURES = (
    SeriesMeasure(
        name="stopping_distance_extension",
        kind="share",
        unit="%",
        meaning="median increase of the braking distance over the mean of the dry stops of the same speed",
        worse="larger",
        values=extensions,
        statistic=median_of,
    ),
    SeriesMeasure(
        name="worst_stopping_distance_extension",
        kind="share",
        unit="%",
        meaning="largest increase of the braking distance over the mean of the dry stops of the same speed",
        worse="larger",
        values=extensions,
        statistic=largest_of,
    ),
    *median_and_worst("braking_distance", "length", "m", "braking distance", BRAKING_DISTANCE),
)
