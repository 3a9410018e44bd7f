"""Whether a train can slow down as a record says: else time or speed is in another unit."""

from __future__ import annotations

import numpy as np

from uictest.field_data.raw import MapError, RawChannel
from uictest.field_data.standstill import first_lasting_fall
from uictest.units import KILOMETRE_PER_HOUR

_LEAST, _LARGEST = 0.01, 20.0
"""m/s2: less than a train loses that rolls out, and twice the acceleration of gravity; chosen."""


def refuse_implausible_deceleration(speed: RawChannel, begin: float) -> None:
    """Raise MapError where the train loses half of its speed from `begin` (s) on as no train does."""
    after = np.isfinite(speed.samples) & (speed.time >= begin)
    since, samples = speed.time[after] - begin, speed.samples[after]
    if not len(since) or samples[0] <= 0.0:
        return
    halved = first_lasting_fall(since, samples, 0.5 * samples[0])
    if halved is None:
        return
    duration = float(since[halved])
    if _LEAST <= 0.5 * samples[0] / duration <= _LARGEST:
        return
    initial_speed = samples[0] / KILOMETRE_PER_HOUR
    raise MapError(
        f"the train slows from {initial_speed:.4g} to {0.5 * initial_speed:.4g} km/h in {duration:.4g} s, at"
        f" {0.5 * samples[0] / duration:.4g} m/s2; {_LEAST} to {_LARGEST} m/s2 are plausible: check the units"
        " of time and speed"
    )
