"""What a channel is at an instant: the one place that reads samples at other times than their own."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

SLACK: Final = 1e-6
"""Share of the usual interval by which an instant may miss a sample and still be that sample's; chosen."""
_ROUNDING: Final = 8
"""Last binary digits by which it may, too: a time that was computed or written in decimals; chosen."""


def usual_interval(time: Array) -> float:
    """Return the median interval of a time axis, s; 0 for fewer than two samples."""
    return float(np.median(np.diff(time))) if len(time) > 1 else 0.0


def slack(time: Array) -> float:
    """Return by how much an instant may miss a sample of a time axis, s."""
    largest = np.abs(time[[0, -1]]).max() if len(time) else 0.0
    return max(SLACK * usual_interval(time), _ROUNDING * float(np.spacing(largest)))


def covers(time: Array, instants: Array) -> NDArray[np.bool_]:
    """Return the mask of instants from the first to the last sample."""
    reach = slack(time)
    return np.asarray((instants >= time[0] - reach) & (instants <= time[-1] + reach))


def rows_at(time: Array, instants: Array) -> tuple[NDArray[np.intp], NDArray[np.bool_]]:
    """Return the row of the last sample up to each instant, else 0, and the mask of instants on a sample."""
    reach = slack(time)
    rows = np.clip(np.searchsorted(time, instants + reach, side="right") - 1, 0, None)
    return rows, np.asarray(np.abs(instants - time[rows]) <= reach)


def at_instants(
    time: Array, samples: Array, instants: Array, *, holds: bool, gaps: NDArray[np.bool_] | None = None
) -> Array:
    """Return the values of a channel at some instants; NaN before its first sample and after its last.

    `time` (or position) increases. A sample stands until the next if the channel `holds`, as a state does;
    else values are interpolated linearly. Instants at or next to NaN are NaN. `gaps`: intervals between
    neighbouring samples in which the channel is unknown.
    """
    last, on_sample = rows_at(time, instants)
    known = covers(time, instants)
    if gaps is not None:
        known &= on_sample | ~gaps[np.minimum(last, len(gaps) - 1)]
    between = samples[last] if holds else np.interp(instants, time, samples)
    return np.where(known, np.where(on_sample, samples[last], between), np.nan)


def common_instants(first: Array, second: Array) -> Array:
    """Return the instants at which two series are compared, whichever is named first: as far as both reach.

    These are the samples of the coarser one: read where only the finer one has samples, the other would lack
    what it did not sample. Of two that are equally coarse they are the samples of both.
    """
    instants = coarser(first, second)
    if instants is None:
        instants = np.union1d(first, second)
        instants = instants[np.diff(instants, prepend=-np.inf) > min(slack(first), slack(second))]
    return instants[covers(first, instants) & covers(second, instants)]


def coarser(first: Array, second: Array) -> Array | None:
    """Return the time axis with the larger mean interval; None where both have the same but for rounding."""
    steps = mean_interval(first), mean_interval(second)
    if max(steps) <= min(steps) * (1.0 + SLACK):
        return None
    return first if steps[0] > steps[1] else second


def mean_interval(time: Array) -> float:
    """Return the mean interval of a time axis, s; 0 for fewer than two samples."""
    return float(time[-1] - time[0]) / (len(time) - 1) if len(time) > 1 else 0.0
