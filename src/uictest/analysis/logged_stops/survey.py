"""Collects what the stops of a log show while they are judged, and says what they show together."""

from __future__ import annotations

from collections.abc import Sequence

from uictest import report
from uictest.analysis.logged_stops.neighbours import (
    FEWEST,
    compared_table,
    findings_table,
    neighbour_differences,
)
from uictest.analysis.logged_stops.rail_tables import rail_tables
from uictest.core.units import KILOMETRE_PER_HOUR
from uictest.judging.evaluation import CaseResult
from uictest.plans.scenario import Case
from uictest.recorded import field_data, service_log


class LogSurvey:
    """What the stops of a log show.

    Args:
        vehicle_known: whether the conditions state vehicle and brake: without, nothing is said of the rail.
    """

    def __init__(self, *, vehicle_known: bool) -> None:
        self._vehicle_known = vehicle_known
        self._signs: list[service_log.WheelsetSigns] = []
        self._uses: list[service_log.RailUse] = []
        self._speeds: dict[str, float] = {}

    def add(self, case: Case, stop: field_data.RecordedStop, result: CaseResult) -> None:
        """Observe one judged stop."""
        self._speeds[case.id] = float(stop.recording["speed"][0]) / KILOMETRE_PER_HOUR
        self._signs.append(service_log.wheelset_signs(stop, result, case.scenario))
        if self._vehicle_known:
            self._uses.append(service_log.rail_use(case.id, stop, case.scenario))

    def campaign(self, results: Sequence[CaseResult]) -> report.Campaign:
        """Return what the stops observed show together; `results` are those of all."""
        differences = neighbour_differences(self._signs)
        findings = findings_table(self._signs, differences)
        tables = (findings, *rail_tables(self._uses, results, self._speeds), compared_table(differences))
        return report.Campaign(tuple(self._sentences(findings)), tables)

    def _sentences(self, findings: report.CampaignTable) -> list[str]:
        found = len(findings.rows)
        sentences = [
            f"{report.counted(found, 'finding')} on wheelsets"
            if found
            else "no wheelset stands out from its neighbours"
        ]
        if len(self._signs) < FEWEST:
            sentences.append(
                f"wheelsets are compared over {report.counted(len(self._signs), 'stop')}: {FEWEST} are needed"
                " for an interval"
            )
        return [*sentences, self._rail_sentence()]

    def _rail_sentence(self) -> str:
        if not self._vehicle_known:
            return "the rail is not examined: state vehicle and brake with --scenario"
        found = [use.friction for use in self._uses if use.standing == "found"]
        seen = f"friction found in {len(found)} of {report.counted(len(self._uses), 'stop')}"
        return (
            f"{seen}: {min(found):.3f} to {max(found):.3f}"
            if found
            else f"{seen}: no wheelset slid long enough"
        )
