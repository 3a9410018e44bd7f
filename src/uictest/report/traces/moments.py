"""When the criteria of a stop were decided: instants and intervals found in every sample of its recording."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Final

import numpy as np
from numpy.typing import NDArray

from uictest.judging import evaluation
from uictest.report.traces.quantities import PLOT_QUANTITIES, WHEELSETS

Samples = NDArray[np.float64]
Channels = Mapping[str, Samples]
Interval = tuple[float, float]
"""First and last time, s since the brake command."""
Extreme = tuple[float, float]
"""Time, s since the brake command, and value, in the unit that the quantity is drawn in."""

TRAIN: Final = 0
"""The number that the train has among the wheelsets 1 .. 4."""


@dataclass(frozen=True, slots=True)
class Moments:
    """When one criterion was decided.

    Args:
        intervals: number of a wheelset -> the intervals that its measure counts.
        extremes: number of a wheelset, or `TRAIN` -> the instant of its largest or smallest value.
        until: the first time at which the criterion no longer applies, s; None where it applies to the end.

    """

    intervals: Mapping[int, Sequence[Interval]] = field(default_factory=dict)
    extremes: Mapping[int, Extreme] = field(default_factory=dict)
    until: float | None = None


def moments_of(verdicts: Iterable[evaluation.Verdict], channels: Channels) -> dict[str, Moments]:
    """Return the moments of each criterion whose measure has any, by the id of the criterion.

    Args:
        verdicts: of the stop; their definitions say what counts.
        channels: every sample of the recording, SI; with `time`, s since the brake command.

    """
    return {
        verdict.id: _FINDERS[verdict.measure](verdict, channels)
        for verdict in verdicts
        if verdict.measure in _FINDERS and "speed" in channels
    }


def _locks(verdict: evaluation.Verdict, channels: Channels) -> Moments:
    """Return when each wheelset was locked while the train moved."""
    locked, moving = verdict.defined("locked_speed"), verdict.defined("moving_speed")
    if locked is None or moving is None:
        return Moments()
    speed = channels["speed"]
    return _intervals(channels, lambda wheel_speed: (speed > moving) & (wheel_speed < locked))


def _slides(verdict: evaluation.Verdict, channels: Channels) -> Moments:
    """Return when each wheelset slid while the train moved."""
    share, slip, moving = map(verdict.defined, ("sliding_slide", "sliding_slip", "moving_speed"))
    if share is None or slip is None or moving is None:
        return Moments()
    speed = channels["speed"]
    return _intervals(
        channels,
        lambda wheel_speed: (
            (speed > moving) & (speed - wheel_speed > share * speed) & (speed - wheel_speed > slip)
        ),
    )


def _largest_slides(verdict: evaluation.Verdict, channels: Channels) -> Moments:
    """Return when each wheelset slid most above the cut-off, and when the train first ran below it."""
    time, speed, cutoff = channels["time"], channels["speed"], verdict.defined("low_speed_cutoff")
    if cutoff is None:
        return Moments(extremes=_largest(channels, "slide", np.ones(len(time), dtype=np.bool_)))
    slower = np.flatnonzero(speed < cutoff)
    until = float(time[slower[0]]) if len(slower) else None
    return Moments(extremes=_largest(channels, "slide", speed > cutoff), until=until)


def _until_end_speed(verdict: evaluation.Verdict, channels: Channels) -> Moments:
    """Return when the train first ran no faster than the speed down to which sliding counts."""
    reached = np.flatnonzero(channels["speed"] <= (verdict.defined("end_speed") or 0.0))
    return Moments(until=float(channels["time"][reached[0]]) if len(reached) else None)


def _largest_forces(verdict: evaluation.Verdict, channels: Channels) -> Moments:
    """Return when the clamping force of each wheelset was largest."""
    everywhere = np.ones(len(channels["time"]), dtype=np.bool_)
    return Moments(extremes=_largest(channels, "clamping_force", everywhere))


def _highest_disc_temperatures(verdict: evaluation.Verdict, channels: Channels) -> Moments:
    """Return when the discs of each wheelset were hottest on their surface."""
    everywhere = np.ones(len(channels["time"]), dtype=np.bool_)
    return Moments(extremes=_largest(channels, "disc_surface_temperature", everywhere))


def _smallest_deceleration(verdict: evaluation.Verdict, channels: Channels) -> Moments:
    """Return when the filtered deceleration was smallest once the brake was developed."""
    return _extreme_deceleration(verdict, channels, verdict.defined("developed_time") or 0.0, -1.0)


def _largest_deceleration(verdict: evaluation.Verdict, channels: Channels) -> Moments:
    """Return when the filtered deceleration was largest."""
    return _extreme_deceleration(verdict, channels, 0.0, 1.0)


def _lowest_reservoir_pressure(verdict: evaluation.Verdict, channels: Channels) -> Moments:
    """Return when the pressure of the reservoir was lowest."""
    pressure = channels.get("reservoir_pressure")
    if pressure is None or not np.isfinite(pressure).any():
        return Moments()
    lowest = int(np.nanargmin(pressure))
    return Moments(extremes={TRAIN: _extreme(channels, "reservoir_pressure", pressure, lowest)})


def _largest_reference_excess(verdict: evaluation.Verdict, channels: Channels) -> Moments:
    """Return when the reference speed was furthest above the train's since a fault first was active."""
    if not {"reference_speed", "active_faults"} <= channels.keys():
        return Moments()
    speed, reference = channels["speed"], channels["reference_speed"]
    counts = (np.cumsum(channels["active_faults"] > 0.0) > 0) & np.isfinite(reference)
    counts &= speed >= (verdict.defined("moving_speed") or 0.0)
    if not counts.any():
        return Moments()
    row = int(np.argmax(np.where(counts, reference - speed, -np.inf)))
    return Moments(extremes={TRAIN: _extreme(channels, "reference_speed", reference, row)})


_FINDERS: Final[Mapping[str, Callable[[evaluation.Verdict, Channels], Moments]]] = MappingProxyType(
    {
        "locked_time": _locks,
        "longest_lock": _locks,
        "longest_lock_of_sound_wheelsets": _locks,
        "reference_excess": _largest_reference_excess,
        "sliding_duration": _slides,
        "maximum_slide_above_cutoff": _largest_slides,
        "sliding_share": _until_end_speed,
        "sliding_share_of_wheelsets": _until_end_speed,
        "maximum_clamping_force": _largest_forces,
        "maximum_disc_temperature": _highest_disc_temperatures,
        "minimum_deceleration": _smallest_deceleration,
        "maximum_deceleration": _largest_deceleration,
        "reservoir_minimum_pressure": _lowest_reservoir_pressure,
    }
)
"""Measure -> what finds its moments; the other measures have none."""


def _intervals(channels: Channels, holds: Callable[[Samples], NDArray[np.bool_]]) -> Moments:
    """Return when a condition on the speed of a wheelset, m/s, holds."""
    intervals = {
        n: _runs(channels["time"], holds(channels[name]))
        for n in WHEELSETS
        if (name := f"wheel_speed_{n}") in channels
    }
    return Moments(intervals={n: runs for n, runs in intervals.items() if runs})


def _runs(time: Samples, holds: NDArray[np.bool_]) -> list[Interval]:
    """Return the intervals from the sample before each run to its last, as the measures count them."""
    ends = np.flatnonzero(np.diff(holds, prepend=False, append=False))
    return [(float(time[max(a - 1, 0)]), float(time[b - 1])) for a, b in ends.reshape(-1, 2).tolist()]


def _largest(channels: Channels, quantity: str, counts: NDArray[np.bool_]) -> dict[int, Extreme]:
    """Return the largest value of each wheelset among the samples that count."""
    largest = {}
    for n in WHEELSETS:
        samples = channels.get(f"{quantity}_{n}")
        if samples is not None and (known := counts & np.isfinite(samples)).any():
            row = int(np.argmax(np.where(known, samples, -np.inf)))
            largest[n] = _extreme(channels, quantity, samples, row)
    return largest


def _extreme(channels: Channels, quantity: str, samples: Samples, row: int) -> Extreme:
    shown = PLOT_QUANTITIES[quantity]
    return float(channels["time"][row]), (float(samples[row]) - shown.zero) / shown.scale


def _extreme_deceleration(
    verdict: evaluation.Verdict, channels: Channels, since: float, sign: float
) -> Moments:
    time_constant = verdict.defined("deceleration_filter")
    time, speed = channels["time"], channels["speed"]
    counts = (speed >= (verdict.defined("moving_speed") or 0.0)) & (time >= since)
    if time_constant is None or not counts.any():
        return Moments()
    filtered = _filtered_deceleration(time, speed, time_constant)
    row = int(np.nanargmax(np.where(counts, sign * filtered, -np.inf)))
    return Moments(extremes={TRAIN: (float(time[row]), float(filtered[row]))})


def _filtered_deceleration(time: Samples, speed: Samples, time_constant: float) -> Samples:
    """Return the deceleration of a train after the low-pass of the measures, m/s2."""
    intervals = np.diff(time)
    decelerations, shares = -np.diff(speed) / intervals, intervals / (intervals + time_constant)
    filtered = np.zeros_like(time)
    last = 0.0
    for k, (deceleration, share) in enumerate(zip(decelerations.tolist(), shares.tolist(), strict=True)):
        last += share * (deceleration - last)
        filtered[k + 1] = last
    return filtered
