"""The friction of the rail under each stop of a log, one coefficient for the whole stop."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Literal, NamedTuple

from uictest import report
from uictest.analysis.logged_stops.stop_groups import LoggedStop
from uictest.plans.scenario import Scenario
from uictest.recorded import fitting
from uictest.recorded.field_data import RecordedStop


class StopFriction(NamedTuple):
    """The friction of the rail in one stop.

    Args:
        standing: `not seen` where no fit is possible, `not one` where no single coefficient describes the
            stop.
        value: initial friction coefficient of a rail that is the same everywhere, or its lower bound.
        half_width: of its 95 % confidence interval.
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
    rows = ((stop.result.id, stop.speed, stop.place, *frictions[stop.result.id]) for stop in stops)
    return report.CampaignTable(
        "friction",
        "Friction of the rail, stop by stop",
        f"As `uictest fit` finds it, one coefficient for the whole stop; {fitting.COVERED}."
        " Not one: no single coefficient describes the stop.",
        "detail",
        columns,
        tuple(rows),
    )
