"""When the train came to a standstill, and whether a train can slow down as recorded."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uictest.core.units import KILOMETRE_PER_HOUR
from uictest.recorded.field_data.raw_channels import Array, MapError, RawChannel

_WINDOW = 0.5
"""s: the deceleration over this time before is assumed to last until standstill; chosen."""
_LONGEST_REST = 2.0
"""s after falling below the standstill speed in which a sample of zero is the same stop's; chosen."""

_LONGEST_DROPOUT = 1.0
"""s after a fall of which the train must be slow for more than half; chosen."""
_LEAST_DECELERATION, _LARGEST_DECELERATION = 0.01, 20.0
"""m/s2: less than that of a train that coasts, and twice the acceleration of gravity; chosen."""


@dataclass(frozen=True, slots=True)
class Standstill:
    """Time of standstill, s, how far the train ran beyond the last sample used, m, and that sample's time."""

    time: float
    beyond: float
    last: float
    text: str


def find_standstill(time: Array, speed: Array, begin: float, slow: float) -> Standstill | None:
    """Return the first standstill after `begin` (s) of a train that falls below `slow` (m/s), else None.

    Where a sample at or below zero follows within two seconds, the standstill lies between it and the
    sample before. Otherwise the train runs on from its slowest sample at the deceleration of the last
    half second.
    """
    known = np.isfinite(speed) & (time >= begin)
    time, speed = time[known], speed[known]
    first = first_lasting_fall(time, speed, slow)
    if first is None or speed[0] <= slow:
        return None
    rest = slice(first, int(np.searchsorted(time, time[first] + _LONGEST_REST, side="right")))
    zero = np.flatnonzero(speed[rest] <= 0.0)
    if len(zero):
        return _between(time, speed, first + int(zero[0]))
    return _run_out(time, speed, first + int(np.argmin(speed[rest])))


def first_lasting_fall(time: Array, speed: Array, level: float) -> int | None:
    """Return the sample at which a speed falls to `level` and stays there for longer than a dropout."""
    below = speed <= level
    for k in np.flatnonzero(below[1:] & ~below[:-1]) + 1:
        end = np.searchsorted(time, time[k] + _LONGEST_DROPOUT, side="right")
        if np.median(speed[k:end]) <= level:
            return int(k)
    return None


def _between(time: Array, speed: Array, zero: int) -> Standstill:
    before, after = float(speed[zero - 1]), float(speed[zero])
    share = before / (before - after)
    moment = float(time[zero - 1] + share * (time[zero] - time[zero - 1]))
    return Standstill(moment, 0.0, moment, "a sample at or below zero")


def _run_out(time: Array, speed: Array, last: int) -> Standstill | None:
    start = int(np.searchsorted(time, time[last] - _WINDOW))
    span = float(time[last] - time[start])
    deceleration = float(speed[start] - speed[last]) / span if span > 0.0 else 0.0
    if deceleration <= 0.0:
        return None
    rest = float(speed[last]) / deceleration
    beyond = 0.5 * float(speed[last]) * rest
    text = f"run out from {float(speed[last]) / KILOMETRE_PER_HOUR:.2f} km/h over {rest:.3f} s"
    return Standstill(float(time[last]) + rest, beyond, float(time[last]), text)


def require_plausible_deceleration(speed: RawChannel, begin: float) -> None:
    """Raise MapError if the train halves its speed after `begin` (s) faster or more slowly than trains can.

    Time or speed is in another unit then.
    """
    after = np.isfinite(speed.samples) & (speed.time >= begin)
    since, samples = speed.time[after] - begin, speed.samples[after]
    if not len(since) or samples[0] <= 0.0:
        return
    halved = first_lasting_fall(since, samples, 0.5 * samples[0])
    if halved is None:
        return
    duration = float(since[halved])
    if _LEAST_DECELERATION <= 0.5 * samples[0] / duration <= _LARGEST_DECELERATION:
        return
    initial_speed = samples[0] / KILOMETRE_PER_HOUR
    raise MapError(
        f"the train slows from {initial_speed:.4g} to {0.5 * initial_speed:.4g} km/h in {duration:.4g} s, at"
        f" {0.5 * samples[0] / duration:.4g} m/s2; {_LEAST_DECELERATION} to {_LARGEST_DECELERATION} m/s2 are"
        " plausible: check the units of time and speed"
    )
