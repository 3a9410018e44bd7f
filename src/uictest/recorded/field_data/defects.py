"""Defects of a record: time axes, missing samples, speeds that drop out, readings that stick or are off."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from uictest.core.recording import LARGEST, at_instants, beyond, states_of, usual_interval
from uictest.core.units import BAR, KILONEWTON
from uictest.recorded.field_data.channel_map import CHANNEL_UNITS, of_wheelsets
from uictest.recorded.field_data.raw_channels import Array, RawChannel, gaps, integrated

DefectKind = Literal[
    "time-missing",
    "time-backwards",
    "time-duplicate",
    "gap",
    "coarse",
    "not-a-number",
    "out-of-range",
    "dropout",
    "spike",
    "stuck",
    "offset",
    "contradiction",
    "starts-late",
    "ends-before-standstill",
]


@dataclass(frozen=True, slots=True)
class Defect:
    """One defect of one channel.

    `makes_unusable`: the channel cannot be used at all. A gap or a missing sample affects only the measures
    that need the missing samples.
    """

    kind: DefectKind
    channel: str
    text: str
    makes_unusable: bool = False

    def __str__(self) -> str:
        """Return the defect for a reader, as in "gap: speed is not recorded from 3.2 to 3.9 s"."""
        return f"{self.kind}: {self.channel} {self.text}"


_LONGEST_GAP = 60.0
"""s within a stop for which nothing may be recorded; chosen."""

_COARSEST = 0.25
"""s between samples, a quarter of the time that the shipped criteria let a wheelset be locked; chosen."""


def disorder(time: Array, names: str) -> Iterator[Defect]:
    """Yield missing, backwards and repeated times; each kind once, with its first sample."""
    missing = ~np.isfinite(time)
    if missing.any():
        first = int(np.argmax(missing)) + 1
        yield Defect(
            "time-missing", names, f"has {_share_text(missing)} without a time, first at sample {first}", True
        )
    with np.errstate(invalid="ignore"):
        step = np.diff(time)
    # A coarse clock repeats most of its times, one that is started late those before its start.
    interval = usual_interval(time) or float(time[-1] - time[0]) / max(len(step), 1)
    stated = f"time: {{interval: {1e3 * interval:.6g} ms}}"
    even = f"; if all samples are evenly spaced, write {stated} in the channel map"
    for kind, wrong, words, remedy in (
        (
            "time-backwards",
            step < 0.0,
            "goes back in time",
            "; sort the rows by time, or cut the record there",
        ),
        ("time-duplicate", step == 0.0, "repeats a time", even if interval > 0.0 else ""),
    ):
        if wrong.any():
            first = int(np.argmax(wrong)) + 1
            where = f"sample {first + 1}: {time[first]:.6g} s after {time[first - 1]:.6g} s"
            text = f"{words} {int(wrong.sum())} times, first at {where}{remedy}"
            yield Defect(kind, names, text, True)  # type: ignore[arg-type]


def gap_defects(time: Array, names: str, grid_interval: float) -> Iterator[Defect]:
    """Yield the gaps of a time axis as one defect."""
    starts = np.flatnonzero(gaps(time, grid_interval))
    listed = ", ".join(f"{time[k]:.6g} to {time[k + 1]:.6g} s" for k in starts[:3])
    more = f" and {len(starts) - 3} more" if len(starts) > 3 else ""
    if len(starts):
        yield Defect("gap", names, f"is not recorded from {listed}{more}")


def interruption(time: Array, begin: float, end: float) -> Iterator[Defect]:
    """Yield the longest gap between two times, s, where it is so long that they hold no stop."""
    inside = time[(time >= begin) & (time <= end)]
    k = int(np.argmax(np.diff(inside))) if len(inside) > 1 else 0
    if len(inside) > 1 and inside[k + 1] - inside[k] > _LONGEST_GAP:
        gap = f"is not recorded from {inside[k]:.6g} to {inside[k + 1]:.6g} s"
        yield Defect("gap", "speed", f"{gap}: the clock steps, or the recording was interrupted", True)


def is_coarse(interval: float) -> bool:
    """Return whether samples `interval` s apart can miss a locked wheelset or a venting valve."""
    return interval > _COARSEST * (1.0 + 1e-6)


def coarse_defects(interval: float, names: str) -> Iterator[Defect]:
    """Yield a sampling interval, s, that can miss a locked wheelset or a venting valve."""
    if is_coarse(interval):
        yield Defect(
            "coarse",
            names,
            f"is sampled every {interval:.6g} s; at most {_COARSEST:g} s shows all that happens",
        )


def without_implausible(channel: RawChannel) -> tuple[RawChannel, list[Defect]]:
    """Return a channel with NaN for samples that are implausibly large or not a state, and the defect."""
    si = CHANNEL_UNITS[channel.name]
    states = sorted(states_of(channel.name).values())
    wrong = beyond(channel.samples, si)
    if states:
        wrong = np.isfinite(channel.samples) & ~np.isin(channel.samples, states)
    if not wrong.any():
        return channel, []
    first, last = channel.time[wrong][[0, -1]]
    limit = f"that are none of the states {', '.join(map(str, states))}" if states else ""
    limit = limit or f"beyond {LARGEST[si].text}"
    text = f"has {_share_text(wrong)} {limit}, from {first:.6g} to {last:.6g} s"
    samples = np.where(wrong, np.nan, channel.samples)
    return replace(channel, samples=samples), [Defect("out-of-range", channel.name, text)]


def missing_samples(channel: RawChannel) -> Iterator[Defect]:
    """Yield the samples of a channel that are not numbers."""
    missing = ~np.isfinite(channel.samples)
    if missing.any():
        first, last = channel.time[missing][[0, -1]]
        text = f"has {_share_text(missing)} that are not numbers, from {first:.6g} to {last:.6g} s"
        yield Defect("not-a-number", channel.name, text)


def _share_text(flagged: NDArray[np.bool_]) -> str:
    return f"{int(flagged.sum())} of {len(flagged)} samples"


_STEEPEST = 150.0
"""m/s2: about three times what a brake or the rail can do to a wheelset; chosen."""
_STEEPEST_TRAIN = 50.0
"""m/s2: of the train, whose speed may be that of a wheelset which slides; chosen."""
_LEAST_JUMP = 2.0
"""m/s: a smaller jump may be noise or the least speed that a sensor reads; chosen."""
_LONGEST_STUCK = 0.5
"""s for which a running wheel may show the same number to the last digit; chosen."""
_SLOWEST_TURN = 0.25
"""m/s2: so slowly a wheel may turn from slide to recovery within a step of a coarse sensor; chosen."""
_TELLING_CHANGE = 0.5
"""m/s by which another speed must change meanwhile; chosen."""
_LARGEST_SPEED_OFFSET = 0.02
"""Share of the train speed: what different wheel diameters explain; chosen."""
_ROLLING = 0.2
"""s after the brake command in which wheels still roll; chosen."""
_DISTANCE_SHARE, _LEAST_DISTANCE = 0.1, 10.0
"""Share of the distance, and m: wheel diameters and slides of the wheel measured explain no more; chosen."""
_REPORTED_SHARE, _LEAST_REPORTED = 0.02, 1.0
"""The same limits from which it is reported: a speed of wheels that slide differs so; chosen."""
_SPEEDS = ("speed", *of_wheelsets("wheel_speed"))
_LARGEST_READING_OFFSET: Final = MappingProxyType(
    {
        "cylinder_pressure": (0.15 * BAR, "Pa"),
        "tank_pressure": (0.15 * BAR, "Pa"),
        "clamping_force": (1.0 * KILONEWTON, "N"),
    }
)
"""Reading with the brake released that a sound sensor may show; chosen."""
_RELEASED = 0.02
"""s after the brake command in which no brake acts yet; chosen."""
_LEAST_CHANGE = 0.1
"""Share of the largest reading by which the other wheelsets' sensors must change meanwhile; chosen."""


def speed_defects(channels: Mapping[str, RawChannel], begin: float, end: float) -> Iterator[Defect]:
    """Yield the defects of train and wheel speeds in a stop from `begin` to `end` (s in the file's time)."""
    yield from _sudden_standstill_defects(channels["speed"], begin, end)
    for name in _SPEEDS:
        if name in channels:
            yield from _dropout_defects(
                channels[name], begin, end, _STEEPEST if name != "speed" else _STEEPEST_TRAIN
            )
            yield from _stuck_speed_defects(channels[name], channels, begin, end)
    yield from _speed_offset_defects(channels, begin)


def _sudden_standstill_defects(speed: RawChannel, begin: float, end: float) -> Iterator[Defect]:
    """Yield a fall to zero at `end` that is steeper than any wheelset can turn: the train did not stop."""
    known = np.isfinite(speed.samples) & (speed.time >= begin)
    time, samples = speed.time[known], speed.samples[known]
    rest = int(np.searchsorted(time, end))
    if not 0 < rest < len(time):
        return
    fall = float(samples[rest - 1] - samples[rest])
    if fall > max(_STEEPEST * float(time[rest] - time[rest - 1]), _LEAST_JUMP):
        text = (
            f"falls at once from {samples[rest - 1]:.4g} to {samples[rest]:.4g} m/s at {time[rest]:.6g} s,"
            " where it is taken for the standstill"
        )
        yield Defect("dropout", speed.name, text, makes_unusable=True)


def _dropout_defects(channel: RawChannel, begin: float, end: float, steepest: float) -> Iterator[Defect]:
    """Yield a fall and a return, or a rise and a return, both steeper than `steepest`, m/s2."""
    time, speed = _finite_samples_between(channel, begin, end)
    if len(time) < 3:
        return
    change, interval = np.diff(speed), np.diff(time)
    jump = np.abs(change) > np.maximum(steepest * interval, _LEAST_JUMP)
    falls, returns = np.flatnonzero(jump & (change < 0.0)), np.flatnonzero(jump & (change > 0.0))
    if len(falls) and len(returns):
        fell = falls[0] < returns[0]
        begins, ends = (falls, returns) if fell else (returns, falls)
        first, last = time[begins[0] + 1], time[max(ends[-1], begins[0] + 1)]
        word = "falls" if fell else "rises"
        text = f"{word} and returns at once, {len(begins)} times from {first:.6g} to {last:.6g} s"
        yield Defect("dropout" if fell else "spike", channel.name, text, makes_unusable=True)


def _stuck_speed_defects(
    channel: RawChannel, channels: Mapping[str, RawChannel], begin: float, end: float
) -> Iterator[Defect]:
    """Yield a constant speed while another one changes. A wheelset at zero is locked, not stuck."""
    time, speed = _finite_samples_between(channel, begin, end)
    steps = np.abs(np.diff(speed))
    step = float(np.min(steps, where=steps > 0.0, initial=_TELLING_CHANGE))
    longest = _LONGEST_STUCK + step / _SLOWEST_TURN
    for first, last in _runs_of_equal_samples(speed):
        long = time[last] - time[first] > longest and abs(speed[first]) > 0.0
        if long and _another_speed_changes(channel, channels, float(time[first]), float(time[last])):
            text = f"stays at {speed[first]:.6g} m/s from {time[first]:.6g} to {time[last]:.6g} s"
            yield Defect("stuck", channel.name, text, makes_unusable=True)
            return


def _runs_of_equal_samples(samples: Array) -> Iterator[tuple[int, int]]:
    """Yield first and last index of every run of equal samples."""
    edges = np.flatnonzero(np.diff(samples) != 0.0)
    starts = [0, *(int(edge) + 1 for edge in edges)]
    ends = [*(int(edge) for edge in edges), len(samples) - 1]
    yield from ((start, end) for start, end in zip(starts, ends, strict=True) if end > start)


def _another_speed_changes(
    channel: RawChannel, channels: Mapping[str, RawChannel], first: float, last: float
) -> bool:
    for name in _SPEEDS:
        if name in channels and name != channel.name:
            _, speed = _finite_samples_between(channels[name], first, last)
            if len(speed) > 1 and np.ptp(speed) > _TELLING_CHANGE:
                return True
    return False


def _speed_offset_defects(channels: Mapping[str, RawChannel], begin: float) -> Iterator[Defect]:
    """Yield wheel speeds that are off while the wheels still roll; the train speed if all are off alike."""
    shares = dict(_rolling_shares(channels, begin))
    off = {name: share for name, share in shares.items() if abs(share) > _LARGEST_SPEED_OFFSET}
    if len(off) > 1 and len(off) == len(shares) and np.ptp(list(off.values())) < _LARGEST_SPEED_OFFSET:
        share = -float(np.mean(list(off.values())))
        yield Defect(
            "offset", "speed", f"differs by {100.0 * share:+.1f} % from all wheels before they brake", True
        )
        return
    for name, share in off.items():
        yield Defect(
            "offset", name, f"differs by {100.0 * share:+.1f} % from the train before it brakes", True
        )


def _rolling_shares(channels: Mapping[str, RawChannel], begin: float) -> Iterator[tuple[str, float]]:
    train = channels["speed"]
    for name in of_wheelsets("wheel_speed"):
        if name not in channels:
            continue
        time, speed = _finite_samples_between(channels[name], begin - 1.0, begin + _ROLLING)
        running = at_instants(train.time, train.samples, time, holds=False)
        known = np.isfinite(running) & (running > 1.0)
        if known.any():
            yield name, float(np.median(speed[known] / running[known]) - 1.0)


def distance_defects(
    channels: Mapping[str, RawChannel], begin: float, end: float, grid_interval: float
) -> Iterator[Defect]:
    """Yield a recorded distance that differs from the integral of the speed from `begin` to `end`, s."""
    if "distance" not in channels:
        return
    ends = np.array([begin, end])
    recorded, made = (
        float(np.diff(np.interp(ends, channel.time, channel.samples))[0])
        for channel in (channels["distance"], integrated(channels["speed"], grid_interval, begin))
    )
    if (difference := abs(recorded - made)) > max(_REPORTED_SHARE * made, _LEAST_REPORTED):
        text = f"grows by {recorded:.5g} m in the stop; by its speed the train runs {made:.5g} m"
        makes_unusable = difference > max(_DISTANCE_SHARE * made, _LEAST_DISTANCE)
        remedy = "; to integrate the speed instead, write channels: {distance: null} in the channel map"
        yield Defect("contradiction", "distance", text + remedy if makes_unusable else text, makes_unusable)


def _finite_samples_between(channel: RawChannel, begin: float, end: float) -> tuple[Array, Array]:
    """Return times and samples from `begin` to `end`, s, without samples that are not finite."""
    inside = (channel.time >= begin) & (channel.time <= end) & np.isfinite(channel.samples)
    return channel.time[inside], channel.samples[inside]


def analogue_defects(channels: Mapping[str, RawChannel], begin: float, end: float) -> Iterator[Defect]:
    """Yield the defects of pressures and forces in a stop from `begin` to `end` (s in the file's time)."""
    for kind, (largest, unit) in _LARGEST_READING_OFFSET.items():
        names = [name for name in of_wheelsets(kind) if name in channels]
        for name in names:
            yield from _reading_offset_defects(channels[name], begin, largest, unit)
            others = [channels[another] for another in names if another != name]
            yield from _stuck_reading_defects(channels[name], others, begin, end)


def _reading_offset_defects(channel: RawChannel, begin: float, largest: float, unit: str) -> Iterator[Defect]:
    before = channel.time <= begin + _RELEASED
    reading = channel.samples[before & (channel.time >= begin - 1.0) & np.isfinite(channel.samples)]
    if len(reading) and abs(float(np.median(reading))) > largest:
        text = f"reads {float(np.median(reading)):.4g} {unit} with the brake released"
        yield Defect("offset", channel.name, text, makes_unusable=True)


def _stuck_reading_defects(
    channel: RawChannel, others: list[RawChannel], begin: float, end: float
) -> Iterator[Defect]:
    _, reading = _finite_samples_between(channel, begin, end)
    if len(reading) < 3 or np.ptp(reading) > 0.0:
        return
    other_readings = [_finite_samples_between(other, begin, end)[1] for other in others]
    if any(len(r) and np.ptp(r) > _LEAST_CHANGE * np.max(np.abs(r)) for r in other_readings):
        yield Defect(
            "stuck", channel.name, f"stays at {reading[0]:.6g} throughout the stop", makes_unusable=True
        )
