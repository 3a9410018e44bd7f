"""The low-pass that a user may ask for: without delay, so that nothing moves in time."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from uictest.field_data.raw import RawChannel
from uictest.field_data.time_axis import usual_interval

_HIGHEST_SHARE = 0.4
"""Of the sampling rate: above it a low-pass would change nothing that was sampled."""


def low_passed(channel: RawChannel, corner: float) -> RawChannel:
    """Return a signal through a low-pass of second order with a corner frequency in Hz, run both ways.

    States are left alone, and so are channels with missing samples, and those sampled so slowly that there is
    nothing above the corner.
    """
    interval = usual_interval(channel.time)
    sound = bool(np.isfinite(channel.samples).all())
    if channel.is_state or not sound or len(channel.time) < 10 or corner * interval > _HIGHEST_SHARE:
        return channel
    from scipy.signal import butter, sosfiltfilt

    count = round((channel.time[-1] - channel.time[0]) / interval) + 1
    even = np.linspace(channel.time[0], channel.time[-1], count)
    sections = butter(1, corner, fs=(count - 1) / (even[-1] - even[0]), output="sos")
    filtered = sosfiltfilt(sections, np.interp(even, channel.time, channel.samples))
    return replace(channel, samples=np.interp(channel.time, even, filtered))
