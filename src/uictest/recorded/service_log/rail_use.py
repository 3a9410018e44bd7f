"""What the rail gave in one recorded stop: adhesion used where wheelsets slid, and the friction behind it."""

from __future__ import annotations

from typing import Final, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.plans.scenario import Scenario
from uictest.recorded import fitting
from uictest.recorded.field_data import WHEELSETS, RecordedStop

Array = NDArray[np.float64]
Standing = Literal["found", "at least", "not one", "not seen"]
_LEAVES: Final = 0.04
"""Share of a friction that one coefficient leaves at most (residual of the balances); chosen: on simulated
rails it leaves 1 to 2 %, on those that sliding cleans 5 to 12 %."""


class RailWindows(NamedTuple):
    """Windows of a stop in which a wheelset slid: arrays of the same length.

    Args:
        wheelset: its number; 0 where only the mean of all is known.
        speed: of the train, m/s.
        place: of the wheelset, m from where the first was at the brake command.
        adhesion: horizontal force over wheel load.
    """

    wheelset: NDArray[np.intp]
    speed: Array
    place: Array
    adhesion: Array


class RailUse(NamedTuple):
    """What the rail gave in a stop.

    Args:
        stop: its name.
        windows: where the brake reached the limit of the rail.
        known_by: what the adhesion is known by.
        standing: of the friction; `not seen` where no fit is possible, `not one` where no single coefficient
            describes the stop.
        friction: initial friction coefficient of a rail that is the same everywhere, or its lower bound.
        half_width: of its 95 % confidence interval.
        remark: why there is no fit.
        place: of the brake command on the line, m; NaN where no distance is recorded.
    """

    stop: str
    windows: RailWindows
    known_by: str
    standing: Standing
    friction: float
    half_width: float
    remark: str = ""
    place: float = np.nan


def rail_use(name: str, stop: RecordedStop, judged_under: Scenario) -> RailUse:
    """Return what the rail gave in a stop of the vehicle, and with the brake, of a scenario."""
    try:
        balances = fitting.balances_of(stop, judged_under)
    except fitting.FitError as error:
        return RailUse(name, _no_windows(), "", "not seen", np.nan, np.nan, str(error), stop.place)
    if not len(balances.windows.first):
        return RailUse(name, _no_windows(), "", "not seen", np.nan, np.nan, "the stop is too short for a fit")
    windows, known_by = _windows(balances)
    fit = fitting.fit_balances(balances, (), with_pads=False)
    (estimate,) = fit.friction
    if estimate.standing == "found" and (left := fit.residual / estimate.value) > _LEAVES:
        remark = (
            f"one coefficient leaves {100.0 * left:.1f} % of it: sliding cleans the rail, it varies, or the"
            " record is noisy"
        )
        return RailUse(name, windows, known_by, "not one", np.nan, np.nan, remark, stop.place)
    standing: Standing = "not seen" if estimate.standing == "not reached" else estimate.standing
    remark = "" if standing == "found" else "no wheelset slid long enough"
    return RailUse(name, windows, known_by, standing, estimate.value, estimate.half_width, remark, stop.place)


def _windows(balances: fitting.Balances) -> tuple[RailWindows, str]:
    """Return the windows of sliding: of each wheelset by its brake, else of all by the train."""
    samples, windows = balances.samples, balances.windows
    middle, slid = (windows.first + windows.last) // 2, windows.sliding & ~windows.standing
    used = balances.adhesion_used()
    if samples.torque is None:
        slid = slid & windows.sliding.all(axis=0) & (np.arange(len(WHEELSETS)) == 0)[:, None]
    row, column = np.nonzero(slid)
    numbers = np.zeros_like(row) if samples.torque is None else row + 1
    by = (
        "deceleration of the train, all wheelsets sliding"
        if samples.torque is None
        else "brake of each wheelset"
    )
    place = samples.place[:, middle]
    return RailWindows(numbers, samples.speed[middle][column], place[row, column], used[row, column]), by


def _no_windows() -> RailWindows:
    none = np.empty(0)
    return RailWindows(np.empty(0, dtype=np.intp), none, none, none)
