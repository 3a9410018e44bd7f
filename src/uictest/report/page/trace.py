"""What the plots of one stop are drawn from: a recording in the engineer's units, thinned out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from uictest.report.page.quantities import QUANTITIES, WHEELSETS, Quantity

if TYPE_CHECKING:
    from uictest.recording import Recording

SAMPLES = 800
"""Samples kept of a channel at most: about one per pixel of the plots."""

DECELERATION_WINDOW = 0.5
"""s: over how long the deceleration that is drawn is averaged; chosen to show what a passenger feels."""

_GRAVITY = 9.80665  # m/s2

Series = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Trace:
    """Series of one stop over time.

    Args:
        time: s since the brake command, increasing.
        series: name -> values in the unit of `quantities.QUANTITIES`; wheelsets have `_1` .. `_4` at the end.
        sliding_time: when a wheelset first slid, s; None where none did or it is not known.

    """

    time: Series
    series: Mapping[str, Series]
    sliding_time: float | None = None

    @property
    def interval(self) -> float:
        """Time between two samples, s (0 for a single sample)."""
        return float(self.time[1] - self.time[0]) if len(self.time) > 1 else 0.0


def trace_of(recording: Recording) -> Trace:
    """Return what is drawn of a recording; every n-th sample, so that at most `SAMPLES` are left."""
    kept = slice(None, None, -(-len(recording) // SAMPLES))
    channels = dict(recording.channels)
    if "speed" in channels:
        channels["deceleration"] = deceleration(channels["time"], channels["speed"])
    series = {
        name: _shown(channels[name][kept], quantity)
        for key, quantity in QUANTITIES.items()
        for name in _names(key, quantity)
        if name in channels
    }
    return Trace(channels["time"][kept], series, _sliding_time(recording.metadata))


def deceleration(time: Series, speed: Series) -> Series:
    """Return the deceleration (g) of a train, averaged over a window around each moment.

    `time` is in s and `speed` in m/s. At the ends of the record the window is what is left of it.
    """
    if len(time) < 2:
        return np.zeros_like(time)
    before = np.maximum(time - DECELERATION_WINDOW / 2, time[0])
    after = np.minimum(time + DECELERATION_WINDOW / 2, time[-1])
    change = np.interp(before, time, speed) - np.interp(after, time, speed)
    return np.asarray(change / (after - before) / _GRAVITY, dtype=np.float64)


def _names(key: str, quantity: Quantity) -> tuple[str, ...]:
    return tuple(f"{key}_{n}" for n in WHEELSETS) if quantity.of_wheelsets else (key,)


def _shown(samples: Series, quantity: Quantity) -> Series:
    return np.asarray(samples, dtype=np.float64) / quantity.scale


def _sliding_time(metadata: Mapping[str, str]) -> float | None:
    written = metadata.get("sliding_time")
    return None if written is None else float(written)
