"""Whether stops change over the days of a log, or over their order where it has no dates.

Least squares with Student's t: the interval of the slope holds where deviations are independent and alike.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from statistics import fmean
from typing import Final, NamedTuple

import numpy as np

from uictest import report
from uictest.analysis.logged_stops.stop_groups import LoggedStop, speed_groups
from uictest.core.document import Cell
from uictest.recorded.service_log import EARLIEST_DATE

_DAY: Final = 86_400.0
_FEWEST: Final = 5
"""Stops without which no slope is told; chosen."""
_LEAST_CHANGE: Final = 3.0
"""% from the first stop to the last below which a slope is no finding; chosen."""


class Drift(NamedTuple):
    """The slope of one quantity.

    Args:
        quantity: what changes.
        over: `day` or `stop`.
        slope, low, high: % per day or stop, with its interval; NaN where there are too few stops.
        change: from the first stop to the last, by the slope, %.
        stops: how many there are.
    """

    quantity: str
    over: str
    slope: float
    low: float
    high: float
    change: float
    stops: int

    @property
    def told(self) -> bool:
        """Whether the interval leaves out zero and the change is large enough."""
        return (self.low > 0.0 or self.high < 0.0) and abs(self.change) > _LEAST_CHANGE


def drifts(stops: Sequence[LoggedStop], friction: Mapping[str, float]) -> list[Drift]:
    """Return the slopes of dry and wet distances and of the friction; `friction` by the name of the stop."""
    places = {stop.result.id: float(number) for number, stop in enumerate(stops)}
    over = "stop"
    if all(stop.time >= EARLIEST_DATE for stop in stops) and stops:
        first = min(stop.time for stop in stops)
        places, over = {stop.result.id: (stop.time - first) / _DAY for stop in stops}, "day"
    series = [each for each in _quantities(stops, friction) if any(each[1])]
    confidence = 1.0 - 0.05 / max(len(series), 1)
    return [_drift(name, over, places, groups, confidence) for name, groups in series]


def _quantities(
    stops: Sequence[LoggedStop], friction: Mapping[str, float]
) -> Iterator[tuple[str, list[Mapping[str, float]]]]:
    """Yield what may change, and its values by the name of the stop in groups that have one mean each."""
    for rail, dry in (("dry", True), ("wet", False)):
        groups = speed_groups([stop for stop in stops if stop.dry is dry]).values()
        distances = [{stop.result.id: stop.distance for stop in group} for group in groups]
        yield f"distance of {rail} stops beside others from the same speed", [*distances]
    yield "friction of the rail, beside its mean", [friction] if friction else []


def _drift(
    name: str,
    over: str,
    places: Mapping[str, float],
    groups: Sequence[Mapping[str, float]],
    confidence: float,
) -> Drift:
    """Return the slope within groups: each has a mean of its own, which is subtracted and no longer free."""
    pairs = [
        np.array([(places[key], 100.0 * v / fmean(own.values())) for key, v in own.items()]) for own in groups
    ]
    x, y = np.concatenate([own - own.mean(axis=0) for own in pairs]).T
    count, free = len(x), len(x) - len(pairs) - 1
    if count < _FEWEST or free < 1 or not np.ptp(x) > 0.0:
        return Drift(name, over, math.nan, math.nan, math.nan, math.nan, count)
    from scipy import stats  # here, since few logs are so long

    line = stats.linregress(x, y)
    error = float(line.stderr) * math.sqrt((count - 2) / free)
    slope, half = float(line.slope), float(stats.t.ppf(0.5 + confidence / 2.0, free)) * error
    change = slope * float(np.ptp(np.concatenate(pairs)[:, 0]))
    return Drift(name, over, slope, slope - half, slope + half, change, count)


_COLUMNS: Final = (
    report.CampaignColumn("quantity", "quantity"),
    report.CampaignColumn("slope", "slope", 3),
    report.CampaignColumn("low", "95 % interval\nfrom", 3),
    report.CampaignColumn("high", "to", 3),
    report.CampaignColumn("unit", "unit"),
    report.CampaignColumn("change", "change in all\n%", 1),
    report.CampaignColumn("stops_counted", "stops", 0),
    report.CampaignColumn("finding", "finding"),
)


def drift_table(found: Sequence[Drift]) -> report.CampaignTable:
    """Return the slopes with their intervals."""

    def row(each: Drift) -> tuple[Cell, ...]:
        few = f"too few stops: {_FEWEST} are needed"
        finding = few if math.isnan(each.slope) else "drifts" if each.told else "no drift told"
        numbers = each.slope, each.low, each.high, f"% per {each.over}", each.change, each.stops
        return each.quantity, *numbers, finding

    return report.CampaignTable(
        "drift",
        "Drift",
        "Least squares within groups of one speed over the dates of the stops, or over their order where the"
        " log has none; intervals by"
        f" Student's t, 95 % for all rows together. Told from {_LEAST_CHANGE:g} % on (chosen).",
        "detail",
        _COLUMNS,
        tuple(row(each) for each in found),
    )
