"""Two logs group by group: their stops do not pair, so means are compared with the intervals of both.

95 % holds for all rows together (Bonferroni). The rails are not the same on both sides: what a row shows is
the difference of the stops, and of the software alone only where nothing else differs.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from statistics import fmean
from typing import Any, Final

from uictest import report
from uictest.analysis.logged_stops.stop_groups import LoggedStop
from uictest.core import envelope
from uictest.core.document import Cell
from uictest.core.measures import column_unit
from uictest.core.series_measures import CountedStop, Figure, largest_of_wheelsets, of_stop
from uictest.core.statistics import difference_interval, mean_interval, proportion_interval
from uictest.core.units import in_unit

_LEFT_OUT: Final = ("error", "skipped", "invalid")
"""Outcomes of stops that say nothing of the WSP."""
_FEWEST: Final = 3
"""Stops of each side below which no mean is compared; chosen."""
_JUDGED: Final = "judged"
"""1 of a stop that passes or fails: one that is inconclusive does neither."""
_DISTANCE: Final = "braking_distance_m"
_BY_SQUARE: Final = ("slid_distance_m", "contact_energy_kj")
"""Of wheelsets, as the distance: what grows with the square of the speed."""
_FIGURES: Final[Mapping[str, Figure]] = {
    _DISTANCE: of_stop(_DISTANCE),
    "initial_adhesion_g": of_stop("initial_adhesion_g"),
    **{
        f"largest_{name}": largest_of_wheelsets(name)
        for name in ("slid_distance_m", "locked_time_s", "contact_energy_kj", "valve_actuations")
    },
    "friction": of_stop("friction"),
}
"""What is compared, and how it is read from a stop; the distance is brought to the nominal speed."""
Group = tuple[str, float]
"""Rail and nominal speed, km/h."""
Stops = Sequence[CountedStop]
Pair = tuple[float, float]


def compare_logs(first: report.RunContent, second: report.RunContent) -> report.CampaignTable:
    """Return by how much the stops of the second log differ from those of the first, group by group."""
    one, other = _groups(first), _groups(second)
    alike = _criteria(first) == _criteria(second)
    common = [group for group in one if group in other]
    known = [
        (group, name) for group in common for name in _FIGURES if _enough(one[group], other[group], name)
    ]
    confidence = 1.0 - 0.05 / max(len(known) + len(common), 1)
    rows: list[tuple[Cell, ...]] = []
    for group in common:
        rows += _shares(group, one[group], other[group], confidence) if alike else ()
        names = [name for of, name in known if of == group]
        rows += [_means(group, name, one[group], other[group], confidence) for name in names]
    alone = ", ".join(_group_text(each) for each in (*one, *other) if each not in common)
    return report.CampaignTable(
        "unpaired",
        "Stops of two logs, unpaired",
        "B - A: means by Student's t, shares by Clopper and Pearson, the intervals of both joined (Zou and"
        " Donner 2008); 95 % for all rows together. Distances and energies are brought to the nominal speed,"
        " times and actuations are not. Rails differ: look at the friction."
        + ("" if alike else " Judged by different criteria: shares that pass are not compared.")
        + (f" On one side only: {alone}." if alone else ""),
        "first",
        _COLUMNS,
        tuple(rows),
    )


_COLUMNS: Final = (
    report.CampaignColumn("rail", "rail"),
    report.CampaignColumn("speed_kmh", "from\nkm/h", 0),
    report.CampaignColumn("quantity", "quantity"),
    report.CampaignColumn("first_stops", "stops\nA", 0),
    report.CampaignColumn("second_stops", "stops\nB", 0),
    report.CampaignColumn("first", "A", "significant"),
    report.CampaignColumn("second", "B", "significant"),
    report.CampaignColumn("difference", "B - A", "significant"),
    report.CampaignColumn("low", "interval\nfrom", "significant"),
    report.CampaignColumn("high", "to", "significant"),
    report.CampaignColumn("unit", "unit"),
    report.CampaignColumn("finding", "finding"),
)


def _groups(content: report.RunContent) -> dict[Group, list[CountedStop]]:
    """Return the stops of a log that count, by rail and nominal speed."""
    frictions = _frictions(content)
    groups: dict[Group, list[CountedStop]] = {}
    for result in content.results:
        measures = dict(result.measures or {})
        squared = 2.0 * measures.get("mean_deceleration_mps2", math.nan) * measures.get(_DISTANCE, math.nan)
        if result.outcome in _LEFT_OUT or not squared > 0.0:
            continue
        rail = content.subject(result.id).settings.get("rail", "")
        stop = LoggedStop(result, in_unit(math.sqrt(squared), "km/h"), rail == "dry")
        if stop.nominal is not None:
            own = measures | {_DISTANCE: stop.distance, "friction": frictions.get(result.id, math.nan)}
            own[_JUDGED] = float(result.outcome in ("pass", "fail"))
            wheelsets = tuple(
                {
                    **each,
                    **{
                        name: stop.to_nominal * each[name]
                        for name in _BY_SQUARE
                        if each.get(name) is not None
                    },
                }
                for each in result.wheelsets
            )
            counted = CountedStop(own, wheelsets, result.outcome == "pass")
            groups.setdefault((rail, stop.nominal), []).append(counted)
    return dict(sorted(groups.items()))


def _criteria(content: report.RunContent) -> set[tuple[Any, ...]]:
    verdicts = (verdict for result in content.results for verdict in result.criteria)
    return {(each.id, each.lower, each.upper, *sorted(each.definition.items())) for each in verdicts}


def _frictions(content: report.RunContent) -> dict[str, float]:
    tables = content.campaign.tables if content.campaign else ()
    rows = [row for table in tables if table.name == "friction" for row in table.data.rows]
    return {str(row[report.STOPS]): float(row["friction"] or 0) for row in rows if row["standing"] == "found"}


def _values(stops: Stops, name: str) -> list[float]:
    return [value for value in map(_FIGURES[name], stops) if math.isfinite(value)]


def _enough(first: Stops, second: Stops, name: str) -> bool:
    return min(len(_values(first, name)), len(_values(second, name))) >= _FEWEST


def _means(group: Group, name: str, first: Stops, second: Stops, confidence: float) -> tuple[Cell, ...]:
    one, other = _values(first, name), _values(second, name)
    sides = ((fmean(values), *mean_interval(values, confidence)) for values in (one, other))
    interval = difference_interval(*sides)
    unit = "" if name == "friction" else column_unit(name.removeprefix("largest_"))
    return _row(group, name, (len(one), len(other)), (fmean(one), fmean(other)), interval, unit)


def _shares(group: Group, first: Stops, second: Stops, confidence: float) -> Iterator[tuple[Cell, ...]]:
    """Yield the shares that pass where every stop was judged: what lacks a channel can fail, but not pass."""
    if all(stop.measures[_JUDGED] for stop in (*first, *second)):
        one, other = ((sum(stop.passed for stop in side), len(side)) for side in (first, second))
        sides = ((side[0] / side[1], *proportion_interval(*side, confidence)) for side in (one, other))
        low, high = (100.0 * end for end in difference_interval(*sides))
        shares = 100.0 * one[0] / one[1], 100.0 * other[0] / other[1]
        yield _row(group, "stops that pass", (one[1], other[1]), shares, (low, high), "%")


def _row(
    group: Group, name: str, counts: tuple[int, int], values: Pair, interval: Pair, unit: str
) -> tuple[Cell, ...]:
    low, high = interval
    finding = "B larger" if low > 0.0 else "B smaller" if high < 0.0 else "not told apart"
    return (*group, name, *counts, *values, values[1] - values[0], low, high, unit, finding)


def _group_text(group: Group) -> str:
    return f"{group[0]} from {group[1]:g} km/h"


def logs_form(first: str, second: str, table: report.CampaignTable) -> dict[str, Any]:
    """Return the comparison of two logs as a JSON document."""
    head = envelope.head(envelope.RESULT, "unpaired")
    return {**head, "first": first, "second": second, "basis": table.basis, "rows": list(table.data.rows)}
