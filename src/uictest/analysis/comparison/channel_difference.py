"""What the second of two recordings has more of a channel than the first, over time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uictest.analysis.comparison.common_samples import CommonSamples, common_samples, over_time
from uictest.analysis.comparison.tolerance import Tolerances
from uictest.core import recording
from uictest.core.recording import state_kind


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


def allowed_of(channel: str, first: recording.Recording, tolerances: Tolerances) -> float:
    """Return how far a channel may lie from its samples in the first recording, in their unit."""
    samples = np.asarray(first[channel], dtype=np.float64)
    known = samples[np.isfinite(samples)]
    return tolerances.of(channel).allowed(float(np.ptp(known)) if len(known) else 0.0)


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
