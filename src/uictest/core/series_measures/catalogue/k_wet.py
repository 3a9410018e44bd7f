"""The increase of the deceleration distance on a slippery rail, and K_wet.

UNISIG SUBSET-040, 4.4.1.5: the deceleration distance is what remains of the distance to standstill behind the
equivalent build-up time of the brake; K_wet = 100/(100 + increase of it over the dry stop in %), of the mean
of the valid wet stops. One factor for all speeds takes the larger increase, which is the smaller K_wet.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from uictest.core.series_measures.estimate import Estimate, mean_of
from uictest.core.series_measures.measure import SeriesMeasure, SpeedStops, of_stop, percent_of_dry

_DECELERATION_DISTANCE = of_stop("deceleration_distance_m")

_NO_DISTANCE: Final = -100.0
"""Increase (%) to a distance of zero."""


def increases(stops: SpeedStops) -> list[float]:
    """Return by how much (%) the deceleration distance of every wet stop exceeds the mean of the dry ones."""
    return [percent - 100.0 for percent in percent_of_dry(_DECELERATION_DISTANCE, stops)]


def k_of_increase(increase: float) -> float:
    """Return 100/(100 + increase), the increase in %."""
    return 100.0 / (100.0 + increase)


def _k_wet(values: Sequence[float], confidence: float) -> Estimate:
    """Return K_wet of the mean increase; without an interval where that of the mean reaches -100 %.

    No distance is below zero: so wide an interval says nothing, and its K_wet would run through infinity.
    """
    increase = mean_of(values, confidence)
    if not increase.low <= _NO_DISTANCE:
        return increase.mapped(k_of_increase)
    return replace(increase, low=math.nan, high=math.nan).mapped(k_of_increase)


MEASURES = (
    SeriesMeasure(
        name="deceleration_distance_extension",
        kind="share",
        unit="%",
        meaning="mean increase of the deceleration distance over the mean of the dry stops of the same speed",
        worse="larger",
        values=increases,
        statistic=mean_of,
    ),
    SeriesMeasure(
        name="k_wet",
        kind="number",
        unit="1",
        meaning="100/(100 + mean increase of the deceleration distance in %)",
        worse="smaller",
        values=increases,
        statistic=_k_wet,
    ),
)
