"""The stops of a log judged together: a series of wet stops, and the worst of them."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import Final

from uictest import report
from uictest.analysis.logged_stops.stop_groups import (
    LoggedStop,
    StopFriction,
    dry_groups,
    dry_table,
    friction_of,
    friction_table,
    outliers_of,
    references,
)
from uictest.analysis.logged_stops.wet_stops import extensions, series_table, wet_series, wet_table
from uictest.core.document import Cell
from uictest.core.units import KILOMETRE_PER_HOUR
from uictest.judging.evaluation import CaseResult, deciding_verdicts, narrowest_margin
from uictest.judging.series import SeriesResult
from uictest.plans.scenario import Case
from uictest.recorded import field_data, service_log
from uictest.recorded.service_log import LoggedEvent, clock_text

_COLUMNS: Final = (
    report.CampaignColumn(report.STOPS, "stop"),
    report.CampaignColumn("outcome", "outcome"),
    report.CampaignColumn("rail", "rail"),
    report.CampaignColumn("clock", "time"),
    report.CampaignColumn("place_m", "on the line at\nm", 0),
    report.CampaignColumn("misses", "misses", wraps=True),
    report.CampaignColumn("braking_distance_m", "distance\nm", 1),
    report.CampaignColumn("extension_percent", "extension\n%", 1),
    report.CampaignColumn("locked_s", "locked\ns", 1),
    report.CampaignColumn("speed_kmh", "from\nkm/h", 1),
    report.CampaignColumn("distance_m", "in the file at\nm", 0),
    report.CampaignColumn("narrowest_margin_percent", ""),
    report.CampaignColumn("criterion", ""),
    report.CampaignColumn("file", ""),
    report.CampaignColumn("sample", ""),
    report.CampaignColumn("time_s", ""),
    report.CampaignColumn("end_speed_kmh", ""),
    report.CampaignColumn("remarks", ""),
)


def worst_table(
    results: Sequence[CaseResult], stops: Sequence[LoggedStop], events: Mapping[str, LoggedEvent]
) -> report.CampaignTable:
    """Return every stop, the worst first, those that could not be judged last; `stops` are those judged."""
    lengths, positions = extensions(stops), {stop.result.id: stop.place for stop in stops}
    dry = {stop.result.id for stop in stops if stop.dry}
    ranked: list[tuple[tuple[float, ...], dict[str, Cell]]] = []
    for result in results:
        margin, criterion = narrowest_margin(result, ("requirement",))
        times = [wheelset.get("locked_time_s") or 0.0 for wheelset in result.wheelsets or ()]
        locked = max((time for time in times if time > 0.0), default=0.0)
        longer = lengths.get(result.id)
        slowest = (result.measures or {}).get("mean_deceleration_mps2", math.nan)
        rank = (
            not result.measures,
            result.requirement_status != "missed",
            result.id in dry,
            math.inf if margin is None else margin,
            -locked,
            -(longer or 0.0),
            slowest if slowest > 0.0 else math.inf,
        )
        record = {
            report.STOPS: result.id,
            "outcome": result.outcome,
            "rail": DRY if result.id in dry else "wet",
            "misses": _misses_text(result, criterion),
            "braking_distance_m": (result.measures or {}).get("braking_distance_m"),
            "narrowest_margin_percent": None if margin is None else round(100.0 * margin, 1),
            "criterion": criterion,
            "locked_s": locked if result.measures else None,
            "extension_percent": longer,
        }
        record |= _event_record(events[result.id], positions.get(result.id, math.nan))
        ranked.append((rank, record))
    return report.CampaignTable.of_records(
        "stops",
        "Stops, the worst first",
        "Those that miss a requirement first, wet ones before dry ones; then by the narrowest margin.",
        "first",
        _COLUMNS,
        [record for _, record in sorted(ranked, key=lambda pair: pair[0])],
    )


def _misses_text(result: CaseResult, criterion: str) -> str:
    """Return what decides that a stop does not pass, the criterion of the narrowest margin where it does."""
    if result.outcome == "pass":
        return ""
    _, verdicts = deciding_verdicts(result.decided)
    first = sorted(verdicts, key=lambda verdict: verdict.id != criterion)[:1]
    return report.missed_sentence(first[0]) if first else result.reason


_PASSED_OVER: Final = tuple(
    report.CampaignColumn(key, "")
    for key in (
        *("file", "sample", "clock", "time_s", "distance_m", "speed_kmh", "end_speed_kmh"),
        *("reason", "remarks"),
    )
)


def passed_over_table(events: Sequence[LoggedEvent]) -> report.CampaignTable:
    """Return the applications of the brake that are no stops; people are told of them in sentences."""
    title, basis = "Passed over", "Applications of the brake that are no stops, with the reason."
    records = map(_event_record, events)
    return report.CampaignTable.of_records("passed_over", title, basis, "file", _PASSED_OVER, records)


def _event_record(event: LoggedEvent, position: float = math.nan) -> dict[str, Cell]:
    """Return where an application of the brake lies in its log and on the line, and why it is not a stop."""
    return {
        "file": event.file.as_posix(),
        "sample": event.row + 1,
        "clock": clock_text(event.time),
        "time_s": event.time,
        "distance_m": round(event.distance, 1),
        "place_m": round(position, 1),
        "speed_kmh": round(event.speed / KILOMETRE_PER_HOUR, 2),
        "end_speed_kmh": round(event.end_speed / KILOMETRE_PER_HOUR, 2),
        "reason": event.reason,
        "remarks": "; ".join(event.remarks),
    }


DRY: Final = "dry"
"""Name of the condition of a dry rail."""


class StopsTogether:
    """What the stops of a log show together.

    Args:
        events: where the stops lie in the log, by name.
        passed_over: applications of the brake that are no stops.
        vehicle_known: whether the conditions state vehicle and brake: without, nothing is said of the rail.
    """

    def __init__(
        self,
        events: Mapping[str, service_log.LoggedEvent],
        passed_over: Sequence[service_log.LoggedEvent],
        *,
        vehicle_known: bool,
    ) -> None:
        self._events, self._passed_over, self._vehicle_known = events, passed_over, vehicle_known
        self._stops: list[LoggedStop] = []
        self._frictions: dict[str, StopFriction] = {}

    def add(self, case: Case, stop: field_data.RecordedStop, result: CaseResult) -> None:
        """Observe one judged stop."""
        speed = float(stop.recording["speed"][0]) / KILOMETRE_PER_HOUR
        dry = case.scenario.rail.condition.name == DRY
        self._stops.append(LoggedStop(result, speed, dry, case, stop.position))
        if self._vehicle_known:
            self._frictions[result.id] = friction_of(stop, case.scenario)

    def campaign(self, results: Sequence[CaseResult]) -> report.Campaign:
        """Return the findings over all stops observed; `results` are those of all."""
        passed_over = (passed_over_table(self._passed_over),) if self._passed_over else ()
        if not results:
            return report.Campaign((self.without_stop,), passed_over)
        series = wet_series(self._stops)
        return report.Campaign(
            (*self._record_sentences(), *self._group_sentences(series), self._rail_sentence()),
            (
                worst_table(results, self._stops, self._events),
                dry_table(self._stops),
                *((friction_table(self._stops, self._frictions),) if self._frictions else ()),
                *((series_table(series),) if series else ()),
                wet_table(self._stops, series),
                *passed_over,
            ),
        )

    @property
    def without_stop(self) -> str:
        """Why there is nothing to show, where no stop was found."""
        if self._passed_over:
            applied = report.counted(len(self._passed_over), "application")
            return f"no stop found: {applied} of the brake passed over, each with its reason"
        return "no stop found: by the channels of the map, the brake is never applied"

    def _record_sentences(self) -> Iterator[str]:
        """Yield the number of stops that are not of the scenario, in all and by each check of the record."""
        of_stops = [
            [each.id for each in stop.result.criteria if each.layer == "record" and each.status == "fail"]
            for stop in self._stops
        ]
        if invalid := sum(map(bool, of_stops)):
            counts = Counter(name for names in of_stops for name in names)
            checks = ", ".join(f"{name} {count}" for name, count in counts.items())
            yield f"invalid by the record: {invalid} of {report.counted(len(of_stops), 'stop')} ({checks})"

    def _group_sentences(self, series: SeriesResult | None) -> Iterator[str]:
        groups = dry_groups(self._stops)
        outliers = [name for group in groups.values() for name in outliers_of(group)]
        if outliers:
            yield f"dry stops beyond 15 % of the others' mean, left out as reference: {', '.join(outliers)}"
        if slid := [stop.result.id for stop in self._stops if stop.dry and stop.slid]:
            yield f"dry stops with a wheelset vented or locked, left out as reference: {', '.join(slid)}"
        if series is None:
            return
        speeds = ", ".join(f"{speed.speed_kmh:g}" for speed in series.speeds)
        if not references(self._stops).keys() & {speed.speed_kmh for speed in series.speeds}:
            dry = report.counted(sum(stop.dry for stop in self._stops), "stop")
            yield f"no dry stop from {speeds} km/h to compare with: {dry} dry, by conditions or --dry"
            return
        for speed in series.speeds:
            value = speed.measures["k_wet"].estimate
            if value is not None:
                missing = report.missing_interval(value)
                interval = f" ({value.low:.3f} to {value.high:.3f})" if not missing else ""
                counts = f"{report.counted(value.stops, 'wet stop')} over {value.dry_stops} dry"
                k_wet = f"K_wet from {speed.speed_kmh:g} km/h: {value.value:.3f}{interval}, {counts}"
                yield f"{k_wet}{'; ' if missing else ''}{missing}"

    def _rail_sentence(self) -> str:
        if not self._vehicle_known:
            return "the rail is not examined: state vehicle and brake with --scenario"
        frictions = self._frictions.values()
        found = [each.value for each in frictions if each.standing == "found"]
        seen = f"friction found in {len(found)} of {report.counted(len(frictions), 'stop')}"
        if several := sum(each.standing == "not one" for each in frictions):
            seen += f", no single one in {several}"
        if found:
            return f"{seen}: {min(found):.3f} to {max(found):.3f}"
        return f"{seen}: {'; '.join(dict.fromkeys(each.remark for each in frictions))}"
