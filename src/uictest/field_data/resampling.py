"""Channels at given times: states held, signals linear between samples, nothing beyond or inside a gap."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from uictest.field_data.raw import Array, RawChannel
from uictest.field_data.time_axis import gaps, usual_interval

_SLACK = 1e-6
"""Share of the sampling interval by which a time may miss a sample and still be the sample's."""


def at(channel: RawChannel, times: Array, raster: float) -> Array:
    """Return a channel at `times` (s, rising); NaN where it was not recorded.

    Args:
        channel: sorted in time; NaN samples stay NaN, and so does what lies between them and others.
        times: where it is wanted.
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
