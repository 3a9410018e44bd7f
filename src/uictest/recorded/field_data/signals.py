"""Signals on the raster of a stop: filtered, resampled, integrated. A gap stays a gap."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from uictest.recorded.field_data.raw_channels import Array, RawChannel
from uictest.recorded.field_data.time_axis import gaps, usual_interval

_SLACK = 1e-6
"""Share of the sampling interval by which a time may miss a sample and still be the sample's."""
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
    slack = _SLACK * usual_interval(channel.time)
    before = np.searchsorted(channel.time, times + slack, side="right") - 1
    inside = (times >= channel.time[0] - slack) & (times <= channel.time[-1] + slack)
    values = _held(channel, before) if channel.is_state else np.interp(times, channel.time, channel.samples)
    on_sample = np.abs(times - channel.time[np.clip(before, 0, None)]) <= slack
    values = np.where(on_sample, channel.samples[np.clip(before, 0, None)], values)
    interval = np.clip(before, 0, len(channel.time) - 2)
    lost = gaps(channel.time, raster)[interval] & ~on_sample
    return np.where(inside & ~lost, values, np.nan)


def _held(channel: RawChannel, before: NDArray[np.intp]) -> Array:
    return np.asarray(channel.samples[np.clip(before, 0, None)])


def integrated(speed: RawChannel, raster: float) -> RawChannel:
    """Return the distance, m: the speed integrated by trapezoids; unknown from the first gap on."""
    steps = 0.5 * (speed.samples[1:] + speed.samples[:-1]) * np.diff(speed.time)
    steps[gaps(speed.time, raster)] = np.nan
    distance: Array = np.concatenate(([0.0], np.cumsum(steps)))
    return replace(speed, name="distance", source=f"{speed.source}, integrated", samples=distance)
