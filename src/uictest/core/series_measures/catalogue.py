"""Every measure of a series, one row each, in the order of results and lists.

K_wet: UNISIG SUBSET-040, 4.4.1.5. The deceleration distance is what remains of the distance to standstill
behind the equivalent build-up time of the brake; K_wet = 100/(100 + increase of it over the dry stop in %),
of the mean of the valid wet stops. One factor for all speeds takes the larger increase: the smaller K_wet.
Distances are corrected: :func:`uictest.core.measures.catalogue.stopping.corrected_distance`.
"""

from __future__ import annotations

import math
from dataclasses import replace
from types import MappingProxyType
from typing import Final

from uictest.core.series_measures.measure import (
    CountedStop,
    Estimate,
    SeriesMeasure,
    largest_of,
    largest_of_wheelsets,
    mean_of,
    median_and_worst,
    median_of,
    of_stop,
    share_of,
)

_BRAKING_DISTANCE = of_stop("corrected_distance_m")


def deceleration_distance(stop: CountedStop) -> float:
    """Return the deceleration distance, m, corrected as the braking distance is."""
    measured, corrected, whole = (
        stop.measures.get(name, math.nan)
        for name in ("deceleration_distance_m", "corrected_distance_m", "braking_distance_m")
    )
    return measured * (corrected / whole) if whole else math.nan


def increase(ratio: Estimate) -> Estimate:
    """Return by how much (%) a distance exceeds that of the dry stops, of their ratio."""
    return _of_distances(ratio).mapped(lambda value: 100.0 * (value - 1.0))


def k_wet(ratio: Estimate) -> Estimate:
    """Return 100/(100 + increase in %), of the ratio of distances."""
    return _of_distances(ratio).mapped(lambda value: 1.0 / value if value > 0.0 else math.inf)


def _of_distances(ratio: Estimate) -> Estimate:
    """Return a ratio of distances without an interval that reaches zero.

    No distance is zero: so wide an interval says nothing, and its K_wet would run through infinity.
    """
    return ratio if not ratio.low <= 0.0 else replace(ratio, low=math.nan, high=math.nan)


def adhesion_utilisation(stop: CountedStop) -> float:
    """Return work done by the rail over work available at the friction maximum, %, for the train."""
    return 100.0 * stop.measures.get("adhesion_utilisation", float("nan"))


def bogie_imbalance(stop: CountedStop) -> float:
    """Return by how much the decelerations that the bogies give differ, in % of their mean."""
    first, second = (stop.measures.get(f"deceleration_bogie_{n}_mps2", math.nan) for n in (1, 2))
    total = first + second
    return 200.0 * abs(first - second) / total if total else math.nan


_MEASURES: Final = (
    SeriesMeasure(
        name="deceleration_distance_extension",
        kind="share",
        unit="%",
        meaning="mean increase of the deceleration distance over the mean of the dry stops of the same speed",
        worse="larger",
        figure=deceleration_distance,
        statistic=mean_of,
        of_ratio=increase,
    ),
    SeriesMeasure(
        name="k_wet",
        kind="number",
        unit="1",
        meaning="100/(100 + mean increase of the deceleration distance in %)",
        worse="smaller",
        figure=deceleration_distance,
        statistic=mean_of,
        of_ratio=k_wet,
    ),
    SeriesMeasure(
        name="stopping_distance_extension",
        kind="share",
        unit="%",
        meaning="median increase of the braking distance over the mean of the dry stops of the same speed",
        worse="larger",
        figure=_BRAKING_DISTANCE,
        statistic=median_of,
        of_ratio=increase,
    ),
    SeriesMeasure(
        name="worst_stopping_distance_extension",
        kind="share",
        unit="%",
        meaning="largest increase of the braking distance over the mean of the dry stops of the same speed",
        worse="larger",
        figure=_BRAKING_DISTANCE,
        statistic=largest_of,
        of_ratio=increase,
    ),
    *median_and_worst("braking_distance", "length", "m", "braking distance", _BRAKING_DISTANCE),
    SeriesMeasure(
        name="passing_share",
        kind="share",
        unit="%",
        meaning="share of the wet stops that meet every requirement on a stop",
        worse="smaller",
        figure=lambda stop: math.nan if stop.passed is None else float(stop.passed),
        statistic=share_of,
        pooled=True,
    ),
    *median_and_worst(
        "locked_time",
        "time",
        "s",
        "time the most locked wheelset is locked in all",
        largest_of_wheelsets("locked_time_s"),
    ),
    *median_and_worst(
        "slid_distance",
        "length",
        "m",
        "distance that the wheelset which slides farthest slides",
        largest_of_wheelsets("slid_distance_m"),
    ),
    *median_and_worst(
        "contact_energy",
        "energy",
        "kJ",
        "largest contact energy of a wheelset",
        largest_of_wheelsets("contact_energy_kj"),
    ),
    *median_and_worst(
        "adhesion_utilisation",
        "share",
        "%",
        "work done by the rail over work available at the friction maximum",
        adhesion_utilisation,
        worse="smaller",
    ),
    *median_and_worst(
        "reservoir_margin",
        "pressure",
        "bar",
        "least pressure of the reservoir over the cylinders",
        of_stop("reservoir_margin_bar"),
        worse="smaller",
    ),
    *median_and_worst(
        "air_consumed", "normal volume", "NL", "air taken from the reservoir", of_stop("air_consumed_nl")
    ),
    *median_and_worst(
        "bogie_imbalance",
        "share",
        "%",
        "difference of the decelerations that the two bogies give, over their mean",
        bogie_imbalance,
    ),
)

SERIES_MEASURES: Final = MappingProxyType({measure.name: measure for measure in _MEASURES})
"""Every measure of a series by name."""
