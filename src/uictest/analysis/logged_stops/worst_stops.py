"""The stops of a log, each with its place in it, the worst first."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, Final

from uictest import report
from uictest.analysis.logged_stops.stop_groups import LoggedStop
from uictest.analysis.logged_stops.wet_stops import extensions
from uictest.core.document import Cell
from uictest.core.units import KILOMETRE_PER_HOUR
from uictest.judging.evaluation import CaseResult, narrowest_margin
from uictest.recorded.service_log import LoggedEvent, clock_text

_COLUMNS: Final = (
    report.CampaignColumn(report.STOPS, "stop"),
    report.CampaignColumn("clock", "time"),
    report.CampaignColumn("distance_m", "in the file at\nm", 0),
    report.CampaignColumn("place_m", "on the line at\nm", 0),
    report.CampaignColumn("speed_kmh", "from\nkm/h", 1),
    report.CampaignColumn("outcome", "outcome"),
    report.CampaignColumn("narrowest_margin_percent", "narrowest margin\n%", 1),
    report.CampaignColumn("criterion", "of requirement"),
    report.CampaignColumn("locked_s", "locked\ns", 1),
    report.CampaignColumn("extension_percent", "extension\n%", 1),
)


def ranked_rows(
    results: Sequence[CaseResult], stops: Sequence[LoggedStop], events: Mapping[str, LoggedEvent]
) -> list[dict[str, Any]]:
    """Return every stop, the worst first, those that could not be judged last; `stops` are those judged."""
    lengths, places = extensions(stops), {stop.result.id: stop.place for stop in stops}
    rows: list[tuple[tuple[float, ...], dict[str, Any]]] = []
    for result in results:
        margin, criterion = narrowest_margin(result, ("requirement",))
        times = [wheelset.get("locked_time_s") or 0.0 for wheelset in result.wheelsets or ()]
        locked = max((time for time in times if time > 0.0), default=0.0)
        longer = lengths.get(result.id)
        slowest = (result.measures or {}).get("mean_deceleration_mps2", math.nan)
        rank = (
            not result.measures,
            result.requirement_status != "missed",
            math.inf if margin is None else margin,
            -locked,
            -(longer or 0.0),
            slowest if slowest > 0.0 else math.inf,
        )
        row = {
            report.STOPS: result.id,
            "outcome": result.outcome,
            "narrowest_margin_percent": None if margin is None else round(100.0 * margin, 1),
            "criterion": criterion,
            "locked_s": locked if result.measures else None,
            "extension_percent": longer,
        }
        rows.append((rank, row | event_row(events[result.id], places.get(result.id, math.nan))))
    return [row for _, row in sorted(rows, key=lambda each: each[0])]


def worst_table(rows: Sequence[Mapping[str, Any]]) -> report.CampaignTable:
    """Return the table of the stops of :func:`ranked_rows`."""
    return report.CampaignTable(
        "stops",
        "Stops, the worst first",
        "A missed requirement first; then by the narrowest margin of a requirement, the time for which a"
        " wheelset is locked, the extension over the dry stops, and the least mean deceleration.",
        "first",
        _COLUMNS,
        tuple(tuple(row[column.key] for column in _COLUMNS) for row in rows),
    )


def event_row(event: LoggedEvent, place: float = math.nan) -> dict[str, Cell]:
    """Return where an application of the brake lies in its log, and why it is no stop."""
    return {
        "file": event.file.as_posix(),
        "sample": event.row + 1,
        "clock": clock_text(event.time),
        "time_s": event.time,
        "distance_m": round(event.distance, 1),
        "place_m": round(place, 1),
        "speed_kmh": round(event.speed / KILOMETRE_PER_HOUR, 2),
        "end_speed_kmh": round(event.end_speed / KILOMETRE_PER_HOUR, 2),
        "reason": event.reason,
        "remarks": "; ".join(event.remarks),
    }
