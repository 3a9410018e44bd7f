"""The two measures that a figure of single stops gives: its median and its worst value."""

from __future__ import annotations

from typing import Literal

from uictest.core.series_measures.estimate import largest_of, median_of, smallest_of
from uictest.core.series_measures.measure import SeriesMeasure
from uictest.core.series_measures.stops import Figure


def median_and_worst(
    name: str,
    kind: str,
    unit: str,
    meaning: str,
    figure: Figure,
    worse: Literal["larger", "smaller"] = "larger",
) -> tuple[SeriesMeasure, SeriesMeasure]:
    """Return `median_NAME` and `worst_NAME` of a figure, which `meaning` describes."""
    which, extreme = ("largest", largest_of) if worse == "larger" else ("smallest", smallest_of)
    median, worst = (
        SeriesMeasure(
            name=f"{prefix}_{name}",
            kind=kind,
            unit=unit,
            meaning=f"{word} of the wet stops: {meaning}",
            worse=worse,
            values=lambda stops: [figure(stop) for stop in stops.wet],
            statistic=statistic,
            figure=figure,
        )
        for prefix, word, statistic in (("median", "median", median_of), ("worst", which, extreme))
    )
    return median, worst
