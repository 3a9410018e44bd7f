"""Defects of time axes and samples, by kind; signals on the raster of a stop."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from uictest.core.recording import LARGEST, at_instants, beyond, states_of, usual_interval
from uictest.recorded.field_data.channel_map import CHANNEL_UNITS
from uictest.recorded.field_data.raw_channels import Array, RawChannel

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

    `spoils`: the channel cannot be used at all. A gap or a missing sample affects only the measures that need
    the missing samples.
    """

    kind: DefectKind
    channel: str
    text: str
    spoils: bool = False

    def __str__(self) -> str:
        """Return the defect for a reader, as in "gap: speed is not recorded from 3.2 to 3.9 s"."""
        return f"{self.kind}: {self.channel} {self.text}"


_GAP_INTERVALS = 2.5
"""An interval longer than this many usual ones is a gap, if it also exceeds the raster; chosen."""

_SLOWER = 1.5
"""Times the interval of its rows that a channel of a rate of its own takes at least; chosen."""
_FEW_SAMPLES = 10
"""Samples that show a rate at least; chosen."""
_LONGEST_GAP = 60.0
"""s within a stop for which nothing may be recorded; chosen."""

_COARSEST = 0.25
"""s between samples, a quarter of the time that the shipped criteria let a wheelset be locked; chosen."""


def by_axis(channels: Iterable[RawChannel]) -> list[list[RawChannel]]:
    """Return the channels that share a time axis together, in their own order."""
    axes: dict[int, list[RawChannel]] = {}
    for channel in channels:
        axes.setdefault(id(channel.time), []).append(channel)
    return list(axes.values())


def disorder(time: Array, names: str) -> Iterator[Defect]:
    """Yield missing, backwards and repeated times; each kind once, with its first place."""
    missing = ~np.isfinite(time)
    if missing.any():
        yield Defect(
            "time-missing", names, f"has {_counted(missing)} without a time, first {_place(missing)}", True
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


def at_own_rates(channels: Mapping[str, RawChannel]) -> dict[str, RawChannel]:
    """Return channels whose samples regularly miss in the rows of others over a time of their own.

    Programs write channels of several rates or clocks into one table so. Whatever else is missing stays so.
    """
    axes: dict[tuple[int, bytes], Array] = {}
    own_rates = dict(channels)
    for name, channel in channels.items():
        present = np.isfinite(channel.samples) & np.isfinite(channel.time)
        times = axes.setdefault((id(channel.time), present.tobytes()), channel.time[present])
        if len(times) < _FEW_SAMPLES or np.all(np.diff(np.flatnonzero(present)) == 1):
            continue
        usual = usual_interval(times)
        slower = usual > _SLOWER * usual_interval(channel.time) and not gaps(times, 0.0).any()
        if slower or np.max(np.diff(times)) <= _SLOWER * usual:
            own_rates[name] = replace(channel, time=times, samples=channel.samples[present])
    return own_rates


def gaps(time: Array, raster: float) -> NDArray[np.bool_]:
    """Return which intervals between neighbouring samples are gaps."""
    longest = max(_GAP_INTERVALS * usual_interval(time), raster * (1.0 + 1e-6))
    return np.asarray(np.diff(time) > longest)


def gap_defects(time: Array, names: str, raster: float) -> Iterator[Defect]:
    """Yield the gaps of a time axis as one defect."""
    starts = np.flatnonzero(gaps(time, raster))
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
    """Return a channel with NaN for samples that are implausibly large or no state, and the defect."""
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
    text = f"has {_counted(wrong)} {limit}, from {first:.6g} to {last:.6g} s"
    samples = np.where(wrong, np.nan, channel.samples)
    return replace(channel, samples=samples), [Defect("out-of-range", channel.name, text)]


def missing_samples(channel: RawChannel) -> Iterator[Defect]:
    """Yield the samples of a channel that are not numbers."""
    missing = ~np.isfinite(channel.samples)
    if missing.any():
        first, last = channel.time[missing][[0, -1]]
        text = f"has {_counted(missing)} that are not numbers, from {first:.6g} to {last:.6g} s"
        yield Defect("not-a-number", channel.name, text)


def _counted(flagged: NDArray[np.bool_]) -> str:
    return f"{int(flagged.sum())} of {len(flagged)} samples"


def _place(flagged: NDArray[np.bool_]) -> str:
    return f"at sample {int(np.argmax(flagged)) + 1}"


_HIGHEST_SHARE = 0.4
"""Of the sampling rate: above it a low-pass would change nothing that was sampled."""


def low_passed(channel: RawChannel, corner: float) -> RawChannel:
    """Return a signal after a low-pass of second order with a corner frequency in Hz, applied both ways.

    States, channels with missing samples and channels sampled so slowly that they hold nothing above the
    corner are returned as they are. Applied both ways, the filter delays nothing.
    """
    interval = usual_interval(channel.time)
    complete = bool(np.isfinite(channel.samples).all())
    if channel.is_state or not complete or len(channel.time) < 10 or corner * interval > _HIGHEST_SHARE:
        return channel
    from scipy.signal import butter, sosfiltfilt

    count = round((channel.time[-1] - channel.time[0]) / interval) + 1
    even = np.linspace(channel.time[0], channel.time[-1], count)
    sections = butter(1, corner, fs=(count - 1) / (even[-1] - even[0]), output="sos")
    filtered = sosfiltfilt(sections, np.interp(even, channel.time, channel.samples))
    return replace(channel, samples=np.interp(channel.time, even, filtered))


def resampled(channel: RawChannel, times: Array, raster: float) -> Array:
    """Return a channel at `times` (s, rising); NaN where it was not recorded.

    Args:
        channel: sorted in time; NaN samples stay NaN, and so does what lies between them and others.
        times: at which samples are returned.
        raster: interval of `times`, s: shorter intervals between samples are no gaps.

    """
    if len(channel.time) < 2:
        return np.full(len(times), np.nan)
    lost = gaps(channel.time, raster)
    return at_instants(channel.time, channel.samples, times, holds=channel.is_state, gaps=lost)


def integrated(speed: RawChannel, raster: float, begin: float) -> RawChannel:
    """Return the distance, m: the speed integrated; unknown from its first gap after `begin`, s."""
    steps = 0.5 * (speed.samples[1:] + speed.samples[:-1]) * np.diff(speed.time)
    steps[gaps(speed.time, raster)] = np.nan
    steps[np.isnan(steps) & (speed.time[1:] <= begin)] = 0.0
    distance: Array = np.concatenate(([0.0], np.cumsum(steps)))
    return replace(speed, name="distance", source=f"{speed.source}, integrated", samples=distance)
