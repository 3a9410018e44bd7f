"""The samples of two recordings at common instants."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.core import recording

Samples = NDArray[np.float64]


class Sampled(NamedTuple):
    """Samples over an abscissa that rises strictly; both have shape (n,)."""

    at: Samples
    values: Samples

    @property
    def step(self) -> float:
        """The mean step of the abscissa; 0 for a single sample."""
        return float(self.at[-1] - self.at[0]) / (len(self.at) - 1) if len(self.at) > 1 else 0.0


@dataclass(frozen=True, slots=True)
class CommonSamples:
    """Two series at the same places; all have shape (n,), and n is 0 where the two share no place."""

    at: Samples
    first: Samples
    second: Samples

    @property
    def difference(self) -> Samples:
        """The second less the first; NaN where a side has no value."""
        return self.second - self.first


def common_samples(first: Sampled, second: Sampled, *, holds: bool = False) -> CommonSamples:
    """Return two series at the places of the one that is sampled more coarsely, as far as both reach.

    The other is read off straight lines between its samples: read at the places of the finer one, the coarser
    would miss what it did not sample. `holds`: a sample stands until the next one, as that of a valve does.
    """
    start, end = max(first.at[0], second.at[0]), min(first.at[-1], second.at[-1])
    places = coarser(first, second).at
    at = places[(places >= start) & (places <= end)]
    return CommonSamples(at, *(_read(side, at, holds=holds) for side in (first, second)))


def coarser(first: Sampled, second: Sampled) -> Sampled:
    """Return the series with the larger mean step; the first where both have the same."""
    # Equal rates differ in their last digits.
    return second if second.step > first.step * (1.0 + 1e-9) else first


def over_time(record: recording.Recording, channel: str) -> Sampled:
    """Return a channel over the time since the brake command (s)."""
    return Sampled(*(np.asarray(record[name], dtype=np.float64) for name in (recording.TIME, channel)))


def over_distance(record: recording.Recording, channel: str) -> Sampled:
    """Return a channel over the distance (m), without the samples at which the train gets no further.

    Raises ValueError with the reason where that makes no sense.
    """
    if DISTANCE not in record.channels:
        raise ValueError(f"there is no {DISTANCE}")
    distance = np.asarray(record[DISTANCE], dtype=np.float64)
    farthest = np.maximum.accumulate(distance)
    # Comparisons with missing samples, and with what is beyond all numbers, are false.
    with np.errstate(invalid="ignore"):
        falls = not np.all(farthest - distance <= _ROLL_BACK)
    if falls:
        raise ValueError(f"the {DISTANCE} has gaps or falls")
    moving = np.diff(farthest, prepend=-np.inf) > 0.0
    if np.count_nonzero(moving) < _FEWEST:
        raise ValueError(f"the {DISTANCE} stands still")
    return Sampled(distance[moving], np.asarray(record[channel], dtype=np.float64)[moving])


DISTANCE = "distance"
_FEWEST = 2
"""Samples that a line takes."""
_ROLL_BACK = 1.0
"""m: a train that has stopped swings back by millimetres; what falls by more is no distance run. Chosen."""


def _read(side: Sampled, at: Samples, *, holds: bool) -> Samples:
    if holds:
        return side.values[np.searchsorted(side.at, at, side="right") - 1]
    return np.interp(at, side.at, side.values)
