"""Stops of a log in groups of one nominal speed: dry ones beside each other, wet ones beside the dry."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from statistics import stdev
from typing import Final

from uictest import report
from uictest.core.document import Cell
from uictest.core.series_measures import SERIES_MEASURES, mean_of
from uictest.judging import series as judged_series
from uictest.judging.evaluation import CaseResult
from uictest.plans import series as series_plans
from uictest.plans.scenario import Case, yaml

_SPEED_STEP: Final = 10.0
"""km/h between nominal speeds; chosen."""
SPEED_TOLERANCE: Final = 3.0
"""km/h from the nominal speed at most, as for a series."""
_ACCEPTED: Final = 15.0
"""% about the mean of a group of dry stops: usual in slide tests, second-hand."""
_CONFIDENCE: Final = 0.95
_NO_MEASURES: Final = ("error", "skipped")
_OF_SLIDING: Final = ("valve_actuations", "locked_time_s")
_LARGEST_MINORITY: Final = 1 / 3
"""Share of outliers in a group beyond which nothing says which stops are off; chosen."""
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


@dataclass(frozen=True, slots=True)
class LoggedStop:
    """A judged stop of a log.

    Args:
        result: of the stop.
        speed: at the brake command, km/h.
        dry: whether it is judged as one on a dry rail.
        time: recorded at the brake command, s; NaN where it is not known.
        case: that it was judged as; None where the result was read back.
    """

    result: CaseResult
    speed: float
    dry: bool
    time: float = math.nan
    case: Case | None = None

    @property
    def nominal(self) -> float | None:
        """The nominal speed, km/h; None where that of the stop is too far from it."""
        nearest = _SPEED_STEP * round(self.speed / _SPEED_STEP)
        return nearest if abs(self.speed - nearest) <= SPEED_TOLERANCE else None

    @property
    def slid(self) -> bool:
        """Whether a wheelset was vented or locked, as far as that is known."""
        wheelsets = self.result.wheelsets or ()
        return any((each.get(name) or 0.0) > 0.0 for each in wheelsets for name in _OF_SLIDING)

    @property
    def distance(self) -> float:
        """The braking distance from the nominal speed at the same mean deceleration, m; NaN without one."""
        measures = self.result.measures or {}
        if self.nominal is None or self.result.outcome in _NO_MEASURES:
            return math.nan
        return float(measures.get("braking_distance_m", math.nan)) * (self.nominal / self.speed) ** 2


def dry_groups(stops: Sequence[LoggedStop]) -> dict[float, list[LoggedStop]]:
    """Return the groups of the dry stops that may be a reference: no wheelset is vented or locks in them."""
    return speed_groups([stop for stop in stops if stop.dry and not stop.slid])


def speed_groups(stops: Sequence[LoggedStop]) -> dict[float, list[LoggedStop]]:
    """Return the stops with a distance by their nominal speed, km/h."""
    groups: dict[float, list[LoggedStop]] = {}
    for stop in stops:
        if stop.nominal is not None and math.isfinite(stop.distance):
            groups.setdefault(stop.nominal, []).append(stop)
    return dict(sorted(groups.items()))


def references(stops: Sequence[LoggedStop]) -> dict[float, list[LoggedStop]]:
    """Return the dry stops that wet ones are compared with: those of :func:`dry_groups` without outliers."""
    groups = {speed: (group, outliers_of(group)) for speed, group in dry_groups(stops).items()}
    kept = {
        speed: [stop for stop in group if stop.result.id not in off] for speed, (group, off) in groups.items()
    }
    return {speed: group for speed, group in kept.items() if group}


def deviations(group: Sequence[LoggedStop]) -> dict[str, float]:
    """Return by how much the distance of each stop exceeds the mean of the others of its group, %.

    Of the others: a stop would hide behind a mean that it makes itself. One stop alone has none.
    """
    total = math.fsum(stop.distance for stop in group)
    others = len(group) - 1
    return {
        stop.result.id: 100.0 * (stop.distance * others / (total - stop.distance) - 1.0)
        for stop in group
        if others
    }


_DRY: Final = (
    report.CampaignColumn("speed_kmh", "from, km/h", 0),
    report.CampaignColumn("dry_stops", "stops", 0),
    report.CampaignColumn("mean_m", "mean\nm", 1),
    report.CampaignColumn("low_m", "95 % interval\nfrom, m", 1),
    report.CampaignColumn("high_m", "to\nm", 1),
    report.CampaignColumn("deviation_percent", "standard deviation\n%", 1),
    report.CampaignColumn("accepted", "within 15 %"),
    report.CampaignColumn(report.STOPS, "outliers"),
)


def dry_table(stops: Sequence[LoggedStop]) -> report.CampaignTable:
    """Return mean, spread and outliers of the dry stops from each speed."""
    return report.CampaignTable(
        "dry_stops",
        "Dry stops by speed",
        "Braking distances, each brought to the nominal speed by the square of the speeds (at most"
        f" {SPEED_TOLERANCE:g} km/h apart). Accepted: within {_ACCEPTED:g} % of the mean of the others. The"
        " width is usual in slide tests (second-hand, no standard at hand); to leave the stop out, of the"
        " mean too, is ours.",
        "first",
        _DRY,
        tuple(_dry_row(speed, group) for speed, group in dry_groups(stops).items()),
    )


def _dry_row(speed: float, group: Sequence[LoggedStop]) -> tuple[Cell, ...]:
    outliers = outliers_of(group)
    # Of those that make the reference; where none does, of all.
    accepted = [stop.distance for stop in group if stop.result.id not in outliers]
    distances = accepted or [stop.distance for stop in group]
    mean = mean_of(distances, _CONFIDENCE)
    percent = 100.0 * stdev(distances) / mean.value if len(distances) > 1 else math.nan
    kept = f"{len(accepted)} of {len(group)}" if len(group) > 1 else "one stop alone"
    return speed, len(group), mean.value, mean.low, mean.high, percent, kept, ", ".join(outliers)


def outliers_of(group: Sequence[LoggedStop]) -> list[str]:
    """Return the stops that lie beyond the accepted width, the farthest first.

    One after the other: an outlier moves the mean of the others, which is made without it then. Of two alone,
    and of a group that falls into several, nothing says which are off: all are.
    """
    remaining, outliers = list(group), list[str]()
    while len(remaining) > 1:
        apart = deviations(remaining)
        farthest = max(apart, key=lambda name: abs(apart[name]))
        if abs(apart[farthest]) <= _ACCEPTED:
            break
        if len(remaining) == 2:
            return [*outliers, *apart]
        outliers.append(farthest)
        remaining = [stop for stop in remaining if stop.result.id != farthest]
    if len(outliers) > _LARGEST_MINORITY * len(group):
        outliers += [stop.result.id for stop in remaining]
    return outliers


def wet_series(stops: Sequence[LoggedStop]) -> judged_series.SeriesResult | None:
    """Return the wet stops as a series beside the dry ones; None without wet stops in a speed group."""
    of_groups = [stop for stop in stops if stop.nominal is not None and stop.case is not None]
    reference = {stop.result.id for group in references(stops).values() for stop in group}
    of_groups = [stop for stop in of_groups if stop.result.outcome not in _NO_MEASURES]
    of_groups = [stop for stop in of_groups if not stop.dry or stop.result.id in reference]
    if not any(not stop.dry for stop in of_groups):
        return None
    ordered = sorted(of_groups, key=lambda stop: not stop.dry)
    planned = series_plans.series_of("log", [_planned(stop) for stop in ordered])
    return judged_series.judge_results(planned, [_from_nominal_speed(stop) for stop in ordered])


def _from_nominal_speed(stop: LoggedStop) -> CaseResult:
    """Return a result with distances from the nominal speed, which no driver keeps as testers do."""
    measures = dict(stop.result.measures or {})
    share = ((stop.nominal or stop.speed) / stop.speed) ** 2
    measures |= {name: share * measures[name] for name in _DISTANCES if name in measures}
    return replace(stop.result, measures=measures)


def _planned(stop: LoggedStop) -> series_plans.PlannedStop:
    assert stop.case is not None
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
    rows: list[tuple[Cell, ...]] = []
    for speed in result.speeds:
        for name in _SHOWN:
            value, measure = speed.measures[name], SERIES_MEASURES[name]
            estimate = value.estimate
            numbers = (estimate.value, estimate.low, estimate.high) if estimate else (None, None, None)
            unit = "" if measure.unit == "1" else measure.unit
            counts = speed.dry.counted, speed.wet.counted
            remark = report.missing_interval(estimate) if estimate else value.unavailable_reason
            rows.append((speed.speed_kmh, name, *numbers, unit, *counts, remark))
    return report.CampaignTable(
        "wet_series",
        "Wet stops as a series",
        "As `uictest evaluate` judges a series; a stop that is no valid test, or was not judged, does not"
        " count. Distances are brought to the nominal speed; intervals hold the scatter of the dry stops.",
        "detail",
        _SERIES,
        tuple(rows),
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
    rows = []
    for stop in stops:
        if stop.dry:
            continue
        name = stop.result.id
        distance = float((stop.result.measures or {}).get("braking_distance_m", math.nan))
        grouped = stop.nominal is not None and stop.result.outcome not in _NO_MEASURES
        why = uncounted.get(name, "") if grouped else "in no group of speeds"
        counts = "yes" if grouped and name not in uncounted else "no"
        cells = distance, lengths.get(name), why or stop.result.reason
        rows.append((name, stop.speed, stop.result.outcome, counts, *cells))
    return report.CampaignTable(
        "wet_stops",
        "Wet stops",
        "Extension: braking distance over the mean of the dry stops, without outliers, from the same nominal"
        " speed, each brought to it.",
        "detail",
        _WET,
        tuple(rows),
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
