"""Collects what the stops of a log show while they are judged, and says what they show together."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import Final

from uictest import report
from uictest.analysis.logged_stops.friction import StopFriction, friction_of, friction_table
from uictest.analysis.logged_stops.stop_groups import (
    LoggedStop,
    dry_groups,
    dry_table,
    outliers_of,
    references,
)
from uictest.analysis.logged_stops.wet_stops import series_table, wet_series, wet_table
from uictest.analysis.logged_stops.worst_stops import event_row, ranked_rows, worst_table
from uictest.core.document import Data
from uictest.core.units import KILOMETRE_PER_HOUR
from uictest.judging.evaluation import CaseResult
from uictest.judging.series import SeriesResult
from uictest.plans.scenario import Case
from uictest.recorded import field_data, service_log

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
        self._stops.append(LoggedStop(result, speed, dry, case, stop.place))
        if self._vehicle_known:
            self._frictions[result.id] = friction_of(stop, case.scenario)

    def campaign(self, results: Sequence[CaseResult]) -> report.Campaign:
        """Return what the stops observed show together; `results` are those of all."""
        if not results:
            return report.Campaign((self.without_stop,))
        series = wet_series(self._stops)
        return report.Campaign(
            (*self._record_sentences(), *self._group_sentences(series), self._rail_sentence()),
            (
                worst_table(ranked_rows(results, self._stops, self._events)),
                dry_table(self._stops),
                *((friction_table(self._stops, self._frictions),) if self._frictions else ()),
                *((series_table(series),) if series else ()),
                wet_table(self._stops, series),
            ),
        )

    def stops_table(self, results: Sequence[CaseResult]) -> Data:
        """Return the stops with their places in the log, the worst first, then what was passed over."""
        ranked = ranked_rows(results, self._stops, self._events)
        stops = [{"stop": row.pop(report.STOPS), **row} for row in ranked]
        return Data.of([*stops, *map(event_row, self._passed_over)])

    @property
    def without_stop(self) -> str:
        """Why there is nothing to show, where no stop was found."""
        if self._passed_over:
            applied = report.counted(len(self._passed_over), "application")
            return f"no stop found: {applied} of the brake passed over, each with its reason"
        return "no stop found: by the channels of the map, the brake is never applied"

    def _record_sentences(self) -> Iterator[str]:
        """Yield how many stops are none of the scenario, and how many by each check of the record."""
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
