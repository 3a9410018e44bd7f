"""The friction of the rail under each stop of a log, one coefficient for the whole stop."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final, Literal, NamedTuple

from uictest import report
from uictest.plans.scenario import Scenario
from uictest.recorded import fitting
from uictest.recorded.field_data import RecordedStop

_LEAVES: Final = 0.04
"""Share of a friction that one coefficient leaves at most (residual of the balances); chosen: on simulated
rails it leaves 1 to 2 %, on those that sliding cleans 5 to 12 %."""


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
    if estimate.standing == "found" and (left := fit.residual / estimate.value) > _LEAVES:
        remark = (
            f"one coefficient leaves {100.0 * left:.1f} % of it: sliding cleans the rail, it varies, or the"
            " record is noisy"
        )
        return StopFriction("not one", remark=remark)
    remark = "" if estimate.standing == "found" else "no wheelset slid long enough"
    standing = "not seen" if estimate.standing == "not reached" else estimate.standing
    return StopFriction(standing, estimate.value, estimate.half_width, remark)


class StopOnRail(NamedTuple):
    """A stop by name, its speed at the brake command, km/h, its place on the line, m, and its friction."""

    stop: str
    speed: float
    place: float
    friction: StopFriction


def friction_table(stops: Sequence[StopOnRail]) -> report.CampaignTable:
    """Return the friction stop by stop, with places where any is known."""
    on_line = any(math.isfinite(each.place) for each in stops)
    columns = (
        report.CampaignColumn(report.STOPS, "stop"),
        report.CampaignColumn("speed_kmh", "from, km/h", 1),
        *((report.CampaignColumn("place_m", "at, m", 0),) if on_line else ()),
        report.CampaignColumn("standing", "friction"),
        report.CampaignColumn("friction", "coefficient", 4),
        report.CampaignColumn("half_width", "+-", 4),
        report.CampaignColumn("remark", "remark", wraps=True),
    )
    rows = ((name, speed, *((place,) if on_line else ()), *own) for name, speed, place, own in stops)
    return report.CampaignTable(
        "friction",
        "Friction of the rail, stop by stop",
        "As `uictest fit` finds it, one coefficient for the whole stop; 95 % confidence for the noise alone."
        " Not one: no single coefficient describes the stop.",
        "detail",
        columns,
        tuple(rows),
    )
