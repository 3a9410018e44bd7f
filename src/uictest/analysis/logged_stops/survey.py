"""Collects what the stops of a log show while they are judged, and says what they show together."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Final

from uictest import report
from uictest.analysis.logged_stops.drift import drift_table, drifts
from uictest.analysis.logged_stops.neighbours import (
    FEWEST,
    NeighbourDifference,
    compared_table,
    findings_table,
    neighbour_differences,
    sliding_sentence,
)
from uictest.analysis.logged_stops.rail_tables import rail_tables
from uictest.analysis.logged_stops.stop_groups import (
    LoggedStop,
    dry_groups,
    dry_table,
    outliers_of,
    references,
)
from uictest.analysis.logged_stops.wet_stops import series_table, wet_series, wet_table
from uictest.core.document import Cell, Data
from uictest.core.units import KILOMETRE_PER_HOUR
from uictest.judging.evaluation import CaseResult, narrowest_margin
from uictest.judging.series import SeriesResult
from uictest.plans.scenario import Case
from uictest.recorded import field_data, service_log

DRY: Final = "dry"
"""Name of the condition of a dry rail."""


class LogSurvey:
    """What the stops of a log show.

    Args:
        times: of the brake commands by the name of the stop, s as recorded.
        passed_over: how many applications of the brake are no stops.
        vehicle_known: whether the conditions state vehicle and brake: without, nothing is said of the rail.
    """

    def __init__(self, times: Mapping[str, float], passed_over: int, *, vehicle_known: bool) -> None:
        self._times, self._passed_over = times, passed_over
        self._vehicle_known = vehicle_known
        self._signs: list[service_log.WheelsetSigns] = []
        self._uses: list[service_log.RailUse] = []
        self._stops: list[LoggedStop] = []

    def add(self, case: Case, stop: field_data.RecordedStop, result: CaseResult) -> None:
        """Observe one judged stop."""
        speed = float(stop.recording["speed"][0]) / KILOMETRE_PER_HOUR
        dry = case.scenario.rail.condition.name == DRY
        self._stops.append(LoggedStop(result, speed, dry, self._times.get(case.id, math.nan), case))
        self._signs.append(service_log.wheelset_signs(stop, result, case.scenario))
        if self._vehicle_known:
            self._uses.append(service_log.rail_use(case.id, stop, case.scenario))

    def campaign(self, results: Sequence[CaseResult]) -> report.Campaign:
        """Return what the stops observed show together; `results` are those of all."""
        if not results:
            return report.Campaign((self.without_stop,))
        differences = neighbour_differences(self._signs)
        findings = findings_table(self._signs, differences)
        series = wet_series(self._stops)
        friction = {use.stop: use.friction for use in self._uses if use.standing == "found"}
        drifting = drift_table(drifts(self._stops, friction))
        speeds = {stop.result.id: stop.speed for stop in self._stops}
        return report.Campaign(
            tuple(self._sentences(findings, differences, series, drifting)),
            (
                findings,
                dry_table(self._stops),
                *rail_tables(self._uses, results, speeds),
                *((series_table(series),) if series else ()),
                wet_table(self._stops, series),
                drifting,
                compared_table(differences),
            ),
        )

    @property
    def without_stop(self) -> str:
        """Why there is nothing to show, where no stop was found."""
        if self._passed_over:
            applied = report.counted(self._passed_over, "application")
            return f"no stop found: {applied} of the brake passed over, each with its reason"
        return "no stop found: by the channels of the map, the brake is never applied"

    def _sentences(
        self,
        findings: report.CampaignTable,
        differences: Sequence[NeighbourDifference],
        series: SeriesResult | None,
        drifting: report.CampaignTable,
    ) -> Iterator[str]:
        compared = max((each.difference.stops for each in differences), default=0)
        if findings.rows:
            yield f"{report.counted(len(findings.rows), 'finding')} on wheelsets"
        elif compared >= FEWEST:
            told = {each.sign for each in differences if each.difference.stops >= FEWEST}
            missing = len(service_log.SIGNS) - len(told)
            rest = (
                f"; {missing} of {len(service_log.SIGNS)} numbers have fewer than {FEWEST} stops to compare"
            )
            yield f"no wheelset stands out from its neighbours{rest if missing else ''}"
        if compared < FEWEST:
            counted = report.counted(compared, "stop")
            yield f"wheelsets are not told apart: {counted} to compare them in, {FEWEST} are needed"
        if sliding := sliding_sentence(differences):
            yield sliding
        yield from self._group_sentences(series)
        yield self._rail_sentence()
        for row in drifting.data.rows:
            if row["finding"] == "drifts":
                yield f"{row['quantity']}: {row['change']:+.1f} % from the first stop to the last"

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
        found = [use.friction for use in self._uses if use.standing == "found"]
        seen = f"friction found in {len(found)} of {report.counted(len(self._uses), 'stop')}"
        if several := sum(use.standing == "not one" for use in self._uses):
            seen += f", no single one in {several}"
        if found:
            return f"{seen}: {min(found):.3f} to {max(found):.3f}"
        return f"{seen}: {'; '.join(dict.fromkeys(use.remark for use in self._uses))}"


def stops_table(
    stops: Mapping[str, service_log.LoggedEvent],
    passed_over: Sequence[service_log.LoggedEvent],
    ranked: Sequence[CaseResult],
    places: Mapping[str, float],
) -> Data:
    """Return where in a log its stops lie, the worst first, and then every other application of the brake.

    `stops` are by name, `ranked` their results; `places` are recorded distances at the brake command, m.
    """
    rows: list[dict[str, Cell]] = []
    for result in ranked:
        margin, criterion = narrowest_margin(result)
        percent = None if margin is None else round(100.0 * margin, 1)
        verdict = {"stop": result.id, "outcome": result.outcome, "narrowest_margin_percent": percent}
        rows.append({**verdict, "criterion": criterion, **_row(stops[result.id], places[result.id])})
    columns = "stop", "outcome", "narrowest_margin_percent", "criterion"
    rows += [dict.fromkeys(columns) | _row(event) for event in passed_over]
    return Data.of(rows)


def _row(event: service_log.LoggedEvent, place: float = math.nan) -> dict[str, Cell]:
    return {
        "file": str(event.file),
        "sample": event.row + 1,
        "time_s": event.time,
        "distance_m": round(event.distance, 1),
        "place_m": round(place, 1),
        "speed_kmh": round(event.speed / KILOMETRE_PER_HOUR, 2),
        "end_speed_kmh": round(event.end_speed / KILOMETRE_PER_HOUR, 2),
        "reason": event.reason,
        "remarks": "; ".join(event.remarks),
    }
