"""Two recordings at common instants, and what the second has more of a channel."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.analysis.comparison.tolerance import Tolerances
from uictest.core import recording
from uictest.core.recording import state_kind
from uictest.core.units import CELSIUS_ZERO, SIZES
from uictest.plans.scenario.yaml import nearest
from uictest.report import shown_unit

Samples = NDArray[np.float64]


class Sampled(NamedTuple):
    """Samples over an abscissa that rises strictly; both have shape (n,)."""

    at: Samples
    values: Samples


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
    """Return two series at their :func:`recording.common_instants`, the same in either order.

    Between samples they are straight lines. `holds`: a sample stands until the next one, as that of a valve
    does.
    """
    at = recording.common_instants(first.at, second.at)
    read = (recording.at_instants(*side, at, holds=holds) for side in (first, second))
    return CommonSamples(at, *read)


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


@dataclass(frozen=True, slots=True)
class WorstInstant:
    """Where two series lie furthest apart: `at` in s or m, both sides in the unit of the channel."""

    at: float
    first: float
    second: float


@dataclass(frozen=True, slots=True)
class ChannelDifference:
    """A channel of two recordings at common instants.

    Args:
        channel: its name.
        unit: of its samples, one of the page.
        samples: both sides over time, s.
        worst: where both sides have a value and lie furthest apart; None where they share no such instant.
        mean: of second - first over these instants; None where there are none.
        allowed: how far the sides may lie apart; None where no tolerance was given.

    """

    channel: str
    unit: str
    samples: CommonSamples
    worst: WorstInstant | None
    mean: float | None
    allowed: float | None = None

    @property
    def within(self) -> bool | None:
        """Whether the sides are nowhere further apart than is allowed; None without a tolerance."""
        if self.allowed is None or self.worst is None:
            return None
        return abs(self.worst.second - self.worst.first) <= self.allowed


def channel_difference(
    channel: str, first: recording.Recording, second: recording.Recording, allowed: float | None = None
) -> ChannelDifference:
    """Return how a channel that both recordings have in the same unit differs."""
    both = common_samples(over_time(first, channel), over_time(second, channel), holds=holds(channel))
    known = both.difference[np.isfinite(both.difference)]
    mean = float(known.mean()) if len(known) else None
    return ChannelDifference(channel, first.units[channel], both, worst_instant(both), mean, allowed)


def allowed_of(channel: str, records: Iterable[recording.Recording], tolerances: Tolerances) -> float:
    """Return how far a channel of two recordings may lie apart, in its unit: by the larger of its ranges."""
    samples = (np.asarray(record[channel], dtype=np.float64) for record in records)
    known = (each[np.isfinite(each)] for each in samples)
    return tolerances.of(channel).allowed(max(float(np.ptp(each)) if len(each) else 0.0 for each in known))


def worst_instant(both: CommonSamples) -> WorstInstant | None:
    """Return where two series lie furthest apart; None where at no place both have a value."""
    apart = np.abs(both.difference)
    if not np.isfinite(apart).any():
        return None
    worst = int(np.argmax(np.where(np.isfinite(apart), apart, -1.0)))
    return WorstInstant(float(both.at[worst]), float(both.first[worst]), float(both.second[worst]))


def holds(channel: str) -> bool:
    """Return whether a sample of a channel stands until the next one."""
    return state_kind(channel) is not None


def in_shown_units(record: recording.Recording) -> recording.Recording:
    """Return a recording in the units of the page: km/h, bar, kN, degC, slides in %."""
    units = {name: shown_unit(name, unit) for name, unit in record.units.items()}
    channels = {
        name: samples if units[name] == record.units[name] else _in_unit(samples, units[name])
        for name, samples in record.channels.items()
    }
    return recording.Recording(channels, units, record.metadata)


def _in_unit(samples: recording.Samples, unit: str) -> recording.Samples:
    exact = np.asarray(samples, dtype=np.float64)  # of short samples, a quotient is short, too
    return exact - CELSIUS_ZERO if unit == "degC" else exact / SIZES[unit]


def common_channels(first: Mapping[str, str], second: Mapping[str, str]) -> list[str]:
    """Return the channels that both recordings have in the same unit, time left out; from their units."""
    return [name for name, unit in first.items() if name != "time" and second.get(name) == unit]


def only_in(first: Mapping[str, str], second: Mapping[str, str]) -> list[str]:
    """Return the channels that only the first recording has; from the units of both."""
    return [name for name in first if name not in second]


def select_channels(patterns: Sequence[str], channels: Iterable[str]) -> list[str]:
    """Return the channels that match a pattern, in the order of the patterns; `*` stands for any text.

    Raises ValueError with the nearest name and all names where a pattern matches none.
    """
    names = list(dict.fromkeys(channels))
    selected: dict[str, None] = {}
    for pattern in patterns:
        matching = [name for name in names if fnmatchcase(name, pattern)]
        if not matching:
            guess = nearest(pattern, names)
            hint = f"did you mean {guess!r}? " if guess else ""
            accepted = ", ".join(names) or "none"
            raise ValueError(f"no channel {pattern!r} on both sides; {hint}both have: {accepted}")
        selected |= dict.fromkeys(matching)
    return list(selected)
