"""A measure of a series as a share of the same figure of the dry stops."""

from __future__ import annotations

from collections.abc import Sequence

from uictest.core.series_measures.measure import SeriesMeasure, SeriesValue, estimated
from uictest.core.series_measures.stops import Figure, SpeedStops


def percent_of_dry(figure: Figure, stops: SpeedStops) -> list[float]:
    """Return a figure of every wet stop as a percentage of its mean over the dry stops of the same speed."""
    reference = stops.dry_mean(figure)
    return [100.0 * figure(stop) / reference if reference else float("nan") for stop in stops.wet]


def dry_relation(measure: SeriesMeasure, speeds: Sequence[SpeedStops], confidence: float) -> SeriesValue:
    """Return the value of a series in percent of the dry stops. Raises ValueError where it has no figure."""
    if measure.figure is None:
        raise ValueError(f"{measure.name!r} is no figure of single stops")
    figure = measure.figure

    def of_speed(stops: SpeedStops) -> SeriesValue:
        if not stops.dry:
            return SeriesValue(unavailable_reason="no dry stop counts")
        if not abs(stops.dry_mean(figure)) > 0.0:
            return SeriesValue(unavailable_reason="the dry stops have no such number, or zero")
        return estimated(percent_of_dry(figure, stops), measure.statistic, confidence)

    return measure.worst([of_speed(stops) for stops in speeds])
