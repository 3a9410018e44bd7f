"""Wet stops of a log compared with the dry ones of the same nominal speed, judged as a series."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

from uictest import report
from uictest.analysis.logged_stops.stop_groups import LoggedStop, references
from uictest.core.document import Cell
from uictest.core.series_measures import SERIES_MEASURES
from uictest.judging import series as judged_series
from uictest.judging.evaluation import CaseResult
from uictest.plans import series as series_plans
from uictest.plans.scenario import yaml

_DISTANCES: Final = ("braking_distance_m", "deceleration_distance_m")
_SHOWN: Final = (
    "k_wet",
    "deceleration_distance_extension",
    "stopping_distance_extension",
    "worst_stopping_distance_extension",
    "median_braking_distance",
    "passing_share",
    "worst_locked_time",
    "worst_slid_distance",
    "median_adhesion_utilisation",
)
"""Measures of a series that are shown, in this order."""


def wet_series(stops: Sequence[LoggedStop]) -> judged_series.SeriesResult | None:
    """Return the wet stops as a series with the dry ones; None without wet stops in a speed group."""
    dry = [stop for group in references(stops).values() for stop in group]
    wet = [stop for stop in stops if stop.grouped and not stop.dry]
    ordered = [*dry, *wet]
    if all(stop.dry for stop in ordered):
        return None
    planned = series_plans.series_of("log", [_planned(stop) for stop in ordered])
    return judged_series.judge_results(planned, [_from_nominal_speed(stop) for stop in ordered])


def _from_nominal_speed(stop: LoggedStop) -> CaseResult:
    """Return a result with distances from the nominal speed of its group: no driver keeps one."""
    measures = dict(stop.result.measures or {})
    measures |= {name: stop.to_nominal * measures[name] for name in _DISTANCES if name in measures}
    measures["corrected_distance_m"] = measures.get("braking_distance_m", math.nan)
    return replace(stop.result, measures=measures)


def _planned(stop: LoggedStop) -> series_plans.PlannedStop:
    speed = yaml.parse_quantity(f"{stop.nominal:g} km/h", "speed")
    scenario = stop.case.scenario.model_copy(update={"initial_speed": speed})
    case = replace(stop.case, scenario=scenario, id=stop.result.id, path=Path(stop.case.path))
    return series_plans.PlannedStop("dry" if stop.dry else "wet", case)


_SERIES: Final = (
    report.CampaignColumn("speed_kmh", "from, km/h", 0),
    report.CampaignColumn("measure", "measure"),
    report.CampaignColumn("value", "value", "significant"),
    report.CampaignColumn("low", "95 % interval\nfrom", "significant"),
    report.CampaignColumn("high", "to", "significant"),
    report.CampaignColumn("unit", "unit"),
    report.CampaignColumn("dry_stops", "dry stops\ncounted", 0),
    report.CampaignColumn("wet_stops", "wet stops\ncounted", 0),
    report.CampaignColumn("remark", "remark", wraps=True),
)


def series_table(result: judged_series.SeriesResult) -> report.CampaignTable:
    """Return the measures of the wet stops from each speed."""
    records: list[dict[str, Cell]] = []
    for speed in result.speeds:
        for name in _SHOWN:
            value, unit = speed.measures[name], SERIES_MEASURES[name].unit
            estimate = value.estimate
            records.append(
                {
                    "speed_kmh": speed.speed_kmh,
                    "measure": name,
                    "value": estimate.value if estimate else None,
                    "low": estimate.low if estimate else None,
                    "high": estimate.high if estimate else None,
                    "unit": "" if unit == "1" else unit,
                    "dry_stops": speed.dry.counted,
                    "wet_stops": speed.wet.counted,
                    "remark": report.missing_interval(estimate) if estimate else value.unavailable_reason,
                }
            )
    return report.CampaignTable.of_records(
        "wet_series",
        "Wet stops as a series",
        "As `uictest evaluate` judges a series; a stop that is no valid test, or was not judged, does not"
        " count. Distances are brought to the nominal speed; intervals hold the scatter of the dry stops.",
        "detail",
        _SERIES,
        records,
    )


_WET: Final = (
    report.CampaignColumn(report.STOPS, "stop"),
    report.CampaignColumn("speed_kmh", "from, km/h", 1),
    report.CampaignColumn("outcome", "outcome"),
    report.CampaignColumn("counts", "counts"),
    report.CampaignColumn("braking_distance_m", "braking distance\nm", 1),
    report.CampaignColumn("extension_percent", "extension\n%", 1),
    report.CampaignColumn("remark", "why not", wraps=True),
)


def wet_table(stops: Sequence[LoggedStop], result: judged_series.SeriesResult | None) -> report.CampaignTable:
    """Return every wet stop with its extension over the dry ones, and whether it counts."""
    lengths = extensions(stops)
    uncounted = {each.case: each.reason for each in result.not_counted} if result else {}
    records: list[dict[str, Cell]] = []
    for stop in stops:
        if stop.dry:
            continue
        judged = stop.result
        why = uncounted.get(judged.id, "") if stop.grouped else "in no group of speeds"
        records.append(
            {
                report.STOPS: judged.id,
                "speed_kmh": stop.speed,
                "outcome": judged.outcome,
                "counts": "yes" if stop.grouped and judged.id not in uncounted else "no",
                "braking_distance_m": float((judged.measures or {}).get("braking_distance_m", math.nan)),
                "extension_percent": lengths.get(judged.id),
                "remark": why or judged.reason,
            }
        )
    return report.CampaignTable.of_records(
        "wet_stops",
        "Wet stops",
        "Extension: braking distance over the mean of the dry stops, without outliers, from the same nominal"
        " speed, each brought to it.",
        "detail",
        _WET,
        records,
    )


def extensions(stops: Sequence[LoggedStop]) -> dict[str, float]:
    """Return by how much the distance of each wet stop exceeds the mean of the dry ones of its speed, %."""
    means = {
        speed: math.fsum(stop.distance for stop in group) / len(group)
        for speed, group in references(stops).items()
    }
    return {
        stop.result.id: 100.0 * (stop.distance / means[stop.nominal] - 1.0)
        for stop in stops
        if not stop.dry and stop.nominal in means and math.isfinite(stop.distance)
    }
