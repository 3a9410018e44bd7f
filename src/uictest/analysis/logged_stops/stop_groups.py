"""The stops of a log in groups: by their initial speed, and the friction that they found."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import stdev
from typing import Final, Literal, NamedTuple

from uictest import report
from uictest.core.document import Cell
from uictest.core.series_measures import mean_of
from uictest.judging.evaluation import CaseResult
from uictest.plans.scenario import Case, Scenario
from uictest.recorded import fitting
from uictest.recorded.field_data import RecordedStop


class StopFriction(NamedTuple):
    """The friction of the rail in one stop.

    Args:
        standing: `not seen` where no fit is possible, `not one` where no single coefficient describes the
            stop.
        value: initial friction coefficient of a rail that is the same everywhere, or its lower bound.
        half_width: half width of its 95 % confidence interval.
        remark: why there is no fit.
    """

    standing: Literal["found", "at least", "not one", "not seen"]
    value: float = math.nan
    half_width: float = math.nan
    remark: str = ""


def friction_of(stop: RecordedStop, judged_under: Scenario) -> StopFriction:
    """Return the friction of the rail under a stop of the vehicle, and with the brake, of a scenario."""
    try:
        fit = fitting.fit_stop(stop, judged_under)
    except fitting.FitError as error:
        return StopFriction("not seen", remark=str(error))
    (estimate,) = fit.friction
    if estimate.standing == "found" and not fit.describes_rail:
        return StopFriction("not one", remark=fit.remark)
    remark = fit.remark if estimate.standing == "found" else "no wheelset slid long enough"
    standing = "not seen" if estimate.standing == "not reached" else estimate.standing
    return StopFriction(standing, estimate.value, estimate.half_width, remark)


def friction_table(
    stops: Sequence[LoggedStop], frictions: Mapping[str, StopFriction]
) -> report.CampaignTable:
    """Return the friction stop by stop, with places where they are known."""
    columns = (
        report.CampaignColumn(report.STOPS, "stop"),
        report.CampaignColumn("speed_kmh", "from, km/h", 1),
        report.CampaignColumn("place_m", "at, m", 0),
        report.CampaignColumn("standing", "friction"),
        report.CampaignColumn("friction", "coefficient", 4),
        report.CampaignColumn("half_width", "+-", 4),
        report.CampaignColumn("remark", "remark", wraps=True),
    )
    records: list[dict[str, Cell]] = [
        {
            report.STOPS: stop.result.id,
            "speed_kmh": stop.speed,
            "place_m": stop.place,
            "standing": friction.standing,
            "friction": friction.value,
            "half_width": friction.half_width,
            "remark": friction.remark,
        }
        for stop in stops
        for friction in [frictions[stop.result.id]]
    ]
    return report.CampaignTable.of_records(
        "friction",
        "Friction of the rail, stop by stop",
        f"As `uictest fit` finds it, one coefficient for the whole stop; {fitting.COVERED}."
        " Not one: no single coefficient describes the stop.",
        "detail",
        columns,
        records,
    )


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


@dataclass(frozen=True, slots=True)
class LoggedStop:
    """A judged stop of a log.

    Args:
        result: result of the stop.
        speed: at the brake command, km/h.
        dry: whether it is judged as one on a dry rail.
        case: case that it was judged as.
        place: recorded distance at the brake command, m.
    """

    result: CaseResult
    speed: float
    dry: bool
    case: Case
    place: float = math.nan

    @property
    def nominal(self) -> float | None:
        """The nominal speed, km/h; None where that of the stop is too far from it."""
        nearest = _SPEED_STEP * round(self.speed / _SPEED_STEP)
        return nearest if abs(self.speed - nearest) <= SPEED_TOLERANCE else None

    @property
    def grouped(self) -> bool:
        """Whether it has measures and is in a group of speeds."""
        return self.nominal is not None and self.result.outcome not in _NO_MEASURES

    @property
    def to_nominal(self) -> float:
        """Factor on what grows with the square of the speed, as from the nominal one."""
        return ((self.nominal or self.speed) / self.speed) ** 2

    @property
    def slid(self) -> bool:
        """Whether a wheelset was vented or locked, as far as that is known."""
        wheelsets = self.result.wheelsets or ()
        return any((each.get(name) or 0.0) > 0.0 for each in wheelsets for name in _OF_SLIDING)

    @property
    def distance(self) -> float:
        """The braking distance from the nominal speed at the same mean deceleration, m; NaN without one."""
        distance = float((self.result.measures or {}).get("braking_distance_m", math.nan))
        return self.to_nominal * distance if self.grouped else math.nan


def dry_groups(stops: Sequence[LoggedStop]) -> dict[float, list[LoggedStop]]:
    """Return the dry stops that may be a reference, by their nominal speed, km/h.

    They have a distance, and no wheelset is vented or locks in them.
    """
    groups: dict[float, list[LoggedStop]] = {}
    for stop in stops:
        if stop.dry and not stop.slid and stop.nominal is not None and math.isfinite(stop.distance):
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
    return report.CampaignTable.of_records(
        "dry_stops",
        "Dry stops by speed",
        "Braking distances, each brought to the nominal speed by the square of the speeds (at most"
        f" {SPEED_TOLERANCE:g} km/h apart). Accepted: within {_ACCEPTED:g} % of the mean of the others. The"
        " width is usual in slide tests (second-hand, no standard at hand); to leave the stop out, of the"
        " mean too, is ours.",
        "first",
        _DRY,
        [_dry_record(speed, group) for speed, group in dry_groups(stops).items()],
    )


def _dry_record(speed: float, group: Sequence[LoggedStop]) -> dict[str, Cell]:
    outliers = outliers_of(group)
    # Of those that make the reference; where none does, of all.
    accepted = [stop.distance for stop in group if stop.result.id not in outliers]
    distances = accepted or [stop.distance for stop in group]
    mean = mean_of(distances, _CONFIDENCE)
    return {
        "speed_kmh": speed,
        "dry_stops": len(group),
        "mean_m": mean.value,
        "low_m": mean.low,
        "high_m": mean.high,
        "deviation_percent": 100.0 * stdev(distances) / mean.value if len(distances) > 1 else math.nan,
        "accepted": f"{len(accepted)} of {len(group)}" if len(group) > 1 else "one stop alone",
        report.STOPS: ", ".join(outliers),
    }


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
        outliers.append(farthest)
        remaining = [stop for stop in remaining if stop.result.id != farthest]
    if len(outliers) > _LARGEST_MINORITY * len(group):
        outliers += [stop.result.id for stop in remaining]
    return outliers
