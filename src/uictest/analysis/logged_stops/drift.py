"""Whether stops change over the days of a log, or over their order where it has no dates.

Least squares with Student's t: the interval of the slope holds where deviations are independent and alike.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Final, NamedTuple

import numpy as np

from uictest import report
from uictest.analysis.logged_stops.stop_groups import LoggedStop, deviations, dry_groups, extensions
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
        quantity: what changes, in its unit.
        unit: of the quantity.
        over: `day` or `stop`.
        slope, low, high: per day or stop, with its interval; NaN where there are too few stops.
        change: from the first stop to the last, by the slope.
        stops: how many there are.
        limit: least size of a change that is told.
    """

    quantity: str
    unit: str
    over: str
    slope: float
    low: float
    high: float
    change: float
    stops: int
    limit: float

    @property
    def told(self) -> bool:
        """Whether the interval leaves out zero and the change is large enough."""
        return (self.low > 0.0 or self.high < 0.0) and abs(self.change) > self.limit


def drifts(stops: Sequence[LoggedStop], friction: Mapping[str, float]) -> list[Drift]:
    """Return the slopes of dry and wet distances and of the friction; `friction` by the name of the stop."""
    places = {stop.result.id: float(number) for number, stop in enumerate(stops)}
    over = "stop"
    if all(stop.time >= EARLIEST_DATE for stop in stops) and stops:
        first = min(stop.time for stop in stops)
        places, over = {stop.result.id: (stop.time - first) / _DAY for stop in stops}, "day"
    series = [each for each in _quantities(stops, friction) if each[2]]
    confidence = 1.0 - 0.05 / max(len(series), 1)
    return [_drift(name, unit, over, places, values, confidence) for name, unit, values in series]


def _quantities(
    stops: Sequence[LoggedStop], friction: Mapping[str, float]
) -> Iterator[tuple[str, str, dict[str, float]]]:
    dry: dict[str, float] = {}
    for group in dry_groups(stops).values():
        dry |= deviations(group)
    yield "distance of dry stops beside others from the same speed", "%", dry
    yield "extension of wet stops", "%", extensions(stops)
    middle = float(np.median(list(friction.values()))) if friction else 1.0
    relative = {name: 100.0 * (value / middle - 1.0) for name, value in friction.items()}
    yield "friction of the rail, beside its median", "%", relative


def _drift(
    name: str,
    unit: str,
    over: str,
    places: Mapping[str, float],
    values: Mapping[str, float],
    confidence: float,
) -> Drift:
    nan = math.nan
    x, y = (np.array(side) for side in zip(*((places[key], values[key]) for key in values), strict=True))
    if len(x) < _FEWEST or not np.ptp(x) > 0.0:
        return Drift(name, unit, over, nan, nan, nan, nan, len(x), _LEAST_CHANGE)
    from scipy import stats  # here, since few logs are so long

    line = stats.linregress(x, y)
    slope, half = float(line.slope), float(stats.t.ppf(0.5 + confidence / 2.0, len(x) - 2) * line.stderr)
    change = slope * float(np.ptp(x))
    return Drift(name, unit, over, slope, slope - half, slope + half, change, len(x), _LEAST_CHANGE)


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
        unit = f"{each.unit} per {each.over}"
        return each.quantity, each.slope, each.low, each.high, unit, each.change, each.stops, finding

    return report.CampaignTable(
        "drift",
        "Drift",
        "Least squares over the dates of the stops, or over their order where the log has none; intervals by"
        f" Student's t, 95 % for all rows together. Told from {_LEAST_CHANGE:g} % on (chosen).",
        "detail",
        _COLUMNS,
        tuple(row(each) for each in found),
    )
