"""Whether a train can slow down as a record says: else time or speed is in another unit."""

from __future__ import annotations

import numpy as np

from uictest.measured.raw import Array, MapError, RawChannel

_LEAST, _LARGEST = 0.01, 20.0
"""m/s2: less than a train loses that rolls out, and twice the acceleration of gravity; chosen."""
_LONGEST_DROPOUT = 1.0
"""s for which a speed may read low without being so; chosen."""


def refuse_implausible_deceleration(speed: RawChannel, begin: float) -> None:
    """Raise MapError where the train loses half of its speed from `begin` (s) on as no train does."""
    after = np.isfinite(speed.samples) & (speed.time >= begin)
    since, samples = speed.time[after] - begin, speed.samples[after]
    duration = _time_to_halve(since, samples) if len(since) > 1 and samples[0] > 0.0 else None
    if duration is None or _LEAST <= 0.5 * samples[0] / duration <= _LARGEST:
        return
    raise MapError(
        f"the train slows from {3.6 * samples[0]:.4g} to {1.8 * samples[0]:.4g} km/h in {duration:.4g} s, at"
        f" {0.5 * samples[0] / duration:.4g} m/s2; {_LEAST} to {_LARGEST} m/s2 are plausible: check the units of"
        " time and speed"
    )


def _time_to_halve(since: Array, speed: Array) -> float | None:
    """Return after how long a speed is halved, and stays so for longer than a dropout; else None."""
    below = speed <= 0.5 * speed[0]
    for k in np.flatnonzero(below[1:] & ~below[:-1]) + 1:
        end = since[k] + max(since[k], _LONGEST_DROPOUT)
        if np.median(speed[k : np.searchsorted(since, end, side="right")]) <= 0.5 * speed[0]:
            return float(since[k])
    return None
