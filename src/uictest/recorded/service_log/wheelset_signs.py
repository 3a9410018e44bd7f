"""Numbers of each wheelset of one recorded stop, by which it is compared with its neighbours."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest import report
from uictest.core.recording import TIME
from uictest.core.units import BAR, KILOMETRE_PER_HOUR
from uictest.judging.evaluation import CaseResult
from uictest.plans.scenario import Scenario
from uictest.recorded.field_data import WHEELSETS, RecordedStop, of_wheelsets

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
_FILL = 0
_SLOWEST = 20.0 * KILOMETRE_PER_HOUR
"""m/s: below, a pole wheel reads too coarsely to compare wheels; chosen."""
_TELLING_DROP = 0.08
"""Share of the pressure by which it must fall for its valve to have answered; chosen. A share, since air
leaves the slower the less there is."""
_LEAST_PRESSURE = 1.0 * BAR
"""Pa from which a vent must show in the pressure; chosen."""
_COARSEST = 0.021
"""s between samples of valve and pressure that tell when it answers; chosen, below the limit of that."""
_LONG_VENT = 0.1
"""s: a vent as long as this must show in the pressure; chosen, longer than valves take to switch."""
_SETTLED = 5.0
"""s after which all valves fill that the pressures have settled; chosen: twice the build-up of position P."""
_UNBRAKED = 0.3
"""s after the brake command in which wheels roll without creep to speak of; chosen."""
_BUILT_UP = 0.5
"""Share of the highest line or cylinder pressure whose time is compared; chosen."""
_LEAST_SLIDING = 5.0
"""% of the braking distance over which some wheelset must slide for slides to be compared; chosen."""
_FEWEST_SAMPLES = 50
"""Samples that a comparison of two sensors needs; chosen."""


class SignKind(NamedTuple):
    """A number of every wheelset that neighbours should share.

    Args:
        meaning: what it is.
        unit: of the number.
        limit: by how much it may differ from the middle one of the other wheelsets; chosen.
        relative: whether the limit is a share of theirs.
        more, less: what a wheelset does whose number lies above, or below; empty where that is no defect.
        digits: behind the point.
        share: of theirs that the limit is where that is more; chosen.
    """

    meaning: str
    unit: str
    limit: float
    relative: bool
    more: str
    less: str
    digits: int = 3
    share: float = 0.0


SIGNS: Final = MappingProxyType(
    {
        "slid_distance": SignKind(
            "share of the braking distance over which it slides",
            "%", 15.0, False, "", "", 1,
        ),
        "rolling_speed": SignKind(
            "excess of the wheel speed over that of the train before the brake has built up",
            "%", 0.7, False, "reads fast: small wheel or sensor", "reads slowly: large wheel or sensor", 2,
        ),
        "speed_roughness": SignKind(
            "change of the wheel speed from sample to sample while all wheelsets roll, root mean square",
            "m/s", 1.0, True, "reads a rough speed", "", 4,
        ),
        "build_up": SignKind(
            "time from the brake command to half of the highest pressure, before any valve acts",
            "s", 0.15, False, "brakes late", "", 2, 0.1,
        ),
        "pressure": SignKind(
            "cylinder pressure with all valves filling",
            "bar", 0.05, True, "holds a higher pressure", "holds a lower pressure", 2,
        ),
        "brake_force": SignKind(
            "clamping force with all valves filling",
            "kN", 0.06, True, "brakes with more force", "brakes weakly", 2,
        ),
        "vent_delay": SignKind(
            "time from the command to vent to a pressure lower by 8 %",
            "s", 0.025, False, "vents late", "", 3,
        ),
        "vent_rate": SignKind(
            "share of the pressure that a vent takes per second",
            "1/s", 0.4, True, "", "vents weakly", 2,
        ),
        "fill_rate": SignKind(
            "rise of the pressure in the first 0.2 s of filling again, as a share of what is missing",
            "1/s", 0.4, True, "", "fills weakly", 2,
        ),
    }
)  # fmt: skip
"""What wheelsets are compared by."""


class WheelsetSigns(NamedTuple):
    """What the wheelsets of one stop did.

    Args:
        stop: its name.
        numbers: kind of sign -> number of each wheelset, NaN where it is not known.
        vents: of each wheelset that should show in its pressure.
        unanswered: how many of them do not.
        defects: what is wrong with the channels of each wheelset: defects found when the record was read.
    """

    stop: str
    numbers: Mapping[str, tuple[float, ...]]
    vents: tuple[int, ...]
    unanswered: tuple[int, ...]
    defects: tuple[tuple[str, ...], ...]


def wheelset_signs(stop: RecordedStop, result: CaseResult, judged_under: Scenario) -> WheelsetSigns:
    """Return what the wheelsets of a judged stop did; `judged_under` says when one slides."""
    course = _Course(stop, judged_under)
    cycles = [course.vents(n) for n in WHEELSETS]
    numbers = {
        "slid_distance": _slid_shares(result),
        "rolling_speed": course.rolling_speeds(),
        "speed_roughness": course.roughnesses(),
        "build_up": course.build_up_times(),
        "pressure": course.settled("cylinder_pressure", BAR),
        "brake_force": course.settled("clamping_force", 1000.0),
        "vent_delay": [_middle(vent.delay for vent in own) for own in cycles],
        "vent_rate": [_middle(vent.rate for vent in own) for own in cycles],
        "fill_rate": [_middle(course.fill_rates(n)) for n in WHEELSETS],
    }
    long = [[vent for vent in own if vent.telling] for own in cycles]
    return WheelsetSigns(
        result.id,
        {name: tuple(map(float, values)) for name, values in numbers.items()},
        tuple(map(len, long)),
        tuple(sum(math.isnan(vent.delay) for vent in own) for own in long),
        tuple(tuple(str(each) for each in stop.defects if each.channel.endswith(f"_{n}")) for n in WHEELSETS),
    )


class _Vent(NamedTuple):
    """A vent: delay of its answer and rate of the fall, NaN without; whether it must show."""

    delay: float
    rate: float
    telling: bool


class _Course:
    """The course of a stop, and where all wheelsets roll."""

    def __init__(self, stop: RecordedStop, judged_under: Scenario) -> None:
        recording, definition = stop.recording, judged_under.measures
        self.channels, self.intervals = recording.channels, stop.intervals
        self.time = np.asarray(recording[TIME])
        self.speed = np.asarray(recording["speed"])
        self.step = float(self.time[1] - self.time[0]) if len(self.time) > 1 else 1.0
        self.wheels = self._of("wheel_speed")
        with np.errstate(invalid="ignore"):
            slip = np.abs(self.speed - self.wheels)
            least = np.maximum(float(definition.sliding_slip), float(definition.sliding_slide) * self.speed)
            known = np.isfinite(self.wheels).any(axis=1)
            rolls = (slip[known] <= least).all(axis=0) if known.any() else np.zeros(len(self.speed), bool)
            self.rolls: Mask = rolls & (self.speed > _SLOWEST)

    def _of(self, kind: str) -> Array:
        """Return a channel of all wheelsets, (4, n); NaN where it is missing."""
        unknown = np.full(len(self.time), np.nan)
        return np.stack([np.asarray(self.channels.get(name, unknown)) for name in of_wheelsets(kind)])

    def _is_fine(self, *names: str) -> bool:
        """Return whether channels are recorded often enough to tell when a valve answers."""
        known = all(name in self.channels for name in names)
        return known and all(self.intervals.get(name, math.inf) <= _COARSEST for name in names)

    def rolling_speeds(self) -> list[float]:
        """Return by how much each wheel reads faster than the train before it brakes, %, so without creep."""
        unbraked = (self.time <= _UNBRAKED) & (self.speed > _SLOWEST)
        return [_middle(own) for own in 100.0 * (self.wheels[:, unbraked] / self.speed[unbraked] - 1.0)]

    def roughnesses(self) -> list[float]:
        """Return the root mean square of the second difference of each wheel speed, m/s."""
        inside = self.rolls[1:-1] & self.rolls[:-2] & self.rolls[2:]
        bends = np.diff(self.wheels, 2, axis=1)[:, inside]
        return [_root_mean_square(own) for own in bends]

    def build_up_times(self) -> list[float]:
        """Return when the pressure of each cylinder reaches half of the highest before any valve acts, s."""
        pressures, acting = self._of("cylinder_pressure"), self._of("valve_command") > _FILL
        first = np.flatnonzero(acting.any(axis=0))
        end = int(first[0]) if len(first) else len(self.time)
        highest = float(np.nanmax(pressures[:, :end], initial=0.0))
        if highest < _LEAST_PRESSURE:
            return [math.nan] * len(WHEELSETS)
        return [_first_time(self.time[:end], own[:end], _BUILT_UP * highest) for own in pressures]

    def settled(self, kind: str, unit: float) -> list[float]:
        """Return the median of a channel, in `unit`, where all valves have been filling for long enough."""
        readings, valves = self._of(kind), self._of("valve_command")
        filling = (valves == _FILL).all(axis=0) if np.isfinite(valves).any() else self.rolls
        since = np.where(filling, 0.0, self.time).astype(np.float64)
        long = self.time - np.maximum.accumulate(since) >= _SETTLED
        return [_middle(own[filling & long] / unit, _FEWEST_SAMPLES) for own in readings]

    def vents(self, n: int) -> list[_Vent]:
        """Return the vents of a wheelset, from the commands to its valve and its pressure."""
        names = f"valve_command_{n}", f"cylinder_pressure_{n}"
        if not self._is_fine(*names):
            return []
        pressure, series = self.channels[names[1]], {names[0]: self.channels[names[0]]}
        return [self._vent(np.asarray(pressure), cycle) for cycle in report.vent_cycles(self.time, series)]

    def _vent(self, pressure: Array, cycle: report.VentCycle) -> _Vent:
        first = round((cycle.start - self.time[0]) / self.step)
        # A pressure goes on falling until the valve has closed again.
        last = min(first + round((cycle.duration + _LONG_VENT) / self.step) + 1, len(pressure))
        begin, own = float(pressure[first]), pressure[first:last]
        fallen = np.flatnonzero(own <= (1.0 - _TELLING_DROP) * begin)
        telling = cycle.duration >= _LONG_VENT and begin >= _LEAST_PRESSURE
        if not len(fallen) or begin < _LEAST_PRESSURE:
            return _Vent(math.nan, math.nan, telling)
        end = first + round(cycle.duration / self.step)
        share = 1.0 - float(pressure[min(end, len(pressure) - 1)]) / begin
        seconds = cycle.duration - float(fallen[0]) * self.step
        rate = -math.log(max(1.0 - share, 1e-3)) / cycle.duration if seconds > 0.0 else math.nan
        return _Vent(float(fallen[0]) * self.step, rate, telling)

    def fill_rates(self, n: int) -> Iterator[float]:
        """Yield how fast the pressure of a wheelset rises after each vent, as a share of what is missing."""
        names = f"valve_command_{n}", f"cylinder_pressure_{n}", "brake_line_pressure"
        if not self._is_fine(*names):
            return
        valve, pressure, line = (self.channels[name] for name in names)
        fills = np.flatnonzero((valve[1:] == _FILL) & (valve[:-1] != _FILL)) + 1
        reach = round(2.0 * _LONG_VENT / self.step)
        for first in map(int, fills):
            last = first + reach
            if last < len(valve) and (valve[first:last] == _FILL).all():
                lacking = float(line[first] - pressure[first])
                if lacking > _LEAST_PRESSURE:
                    yield float(pressure[last] - pressure[first]) / lacking / (reach * self.step)


def _slid_shares(result: CaseResult) -> list[float]:
    distance = (result.measures or {}).get("braking_distance_m", math.nan)
    shares = [100.0 * each.get("slid_distance_m", math.nan) / distance for each in result.wheelsets]
    seen = any(share >= _LEAST_SLIDING for share in shares)
    return shares if seen else [math.nan] * len(WHEELSETS)


def _middle(values: Iterator[float] | Sequence[float] | Array, fewest: int = 1) -> float:
    known = [value for value in values if math.isfinite(value)]
    return float(np.median(known)) if len(known) >= fewest else math.nan


def _root_mean_square(values: Array) -> float:
    known = values[np.isfinite(values)]
    return float(np.sqrt(np.mean(known**2))) if len(known) >= _FEWEST_SAMPLES else math.nan


def _first_time(time: Array, pressure: Array, level: float) -> float:
    above = np.flatnonzero(pressure >= level)
    return float(time[above[0]]) if len(above) else math.nan
