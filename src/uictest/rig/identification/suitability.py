"""Whether a record supports an identification: its brake applications, what it must hold."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from uictest.core.units import BAR
from uictest.rig.identification.lines import Mask, Samples, runs

EVENNESS = 0.01
"""Largest departure of one sampling interval from their median, as a share of it; chosen."""
_SMALLEST_SPAN = 0.2 * BAR
"""Pa: range that a pressure must cover; chosen."""
_SWING, _FEWEST_SWINGS = 0.1, 4
"""A swing is a turn by this share of the range; a record needs so many; chosen."""
_SPACING = 0.01
"""Time in s between the samples in which swings are looked for; chosen."""
_SEGMENTS = 20
"""Segments of a record, some of which are held out; chosen."""


class UnsuitableRecordError(ValueError):
    """A record that does not support an identification; the message says why."""


def required_sampling_time(
    time: Samples, pressures: dict[str, Samples], shortest: float, longest: float
) -> float:
    """Return the even sampling time in s of a record whose pressures vary; tank and cylinder must differ.

    Args:
        time: s.
        pressures: `tank` and `cylinder` pressure, and any others that are finite, Pa.
        shortest: duration that the record must have, s.
        longest: sampling time that it may have, s.

    Raises:
        UnsuitableRecordError: the record cannot support an identification; the message says why.
    """
    require_finite({"time": time, **pressures})
    require_duration(time, shortest)
    step = sampling_time(time, longest)
    for name in ("tank", "cylinder"):
        pressure = pressures[name]
        require_excitation(f"{name}_pressure", pressure, step)
        if pressure.max() <= 0.0:
            raise UnsuitableRecordError(f"the {name} pressure is never above zero: is its sign wrong?")
    if np.array_equal(pressures["tank"], pressures["cylinder"]):
        raise UnsuitableRecordError("tank and cylinder pressure are the same, sample by sample: no dynamics")
    return step


def require_finite(channels: dict[str, Samples]) -> None:
    """Raise UnsuitableRecordError if samples of a channel are missing or infinite."""
    for name, samples in channels.items():
        wrong = np.count_nonzero(~np.isfinite(samples))
        if wrong:
            first = int(np.argmin(np.isfinite(samples)))
            raise UnsuitableRecordError(
                f"channel {name!r} has {wrong} samples that are not numbers, the first at sample {first}"
            )


def require_duration(time: Samples, shortest: float) -> None:
    """Raise UnsuitableRecordError if a record is shorter than ``shortest`` s."""
    duration = float(time[-1] - time[0]) if len(time) else 0.0
    if duration < shortest:
        raise UnsuitableRecordError(f"too short: {duration:.3g} s, at least {shortest:g} s are needed")


def sampling_time(time: Samples, longest: float) -> float:
    """The even sampling time of a record in s. Raises UnsuitableRecordError when it is uneven or too long."""
    intervals = np.diff(time)
    median = float(np.median(intervals))
    worst = int(np.argmax(np.abs(intervals - median)))
    if abs(intervals[worst] - median) > EVENNESS * median:
        raise UnsuitableRecordError(
            f"uneven sampling: {intervals[worst] * 1e3:.4g} ms at {time[worst]:.6g} s"
            f" where {median * 1e3:.4g} ms is usual"
        )
    if median > longest * (1.0 + EVENNESS):
        raise UnsuitableRecordError(
            f"sampled every {median * 1e3:.4g} ms; the dynamics need {longest * 1e3:g} ms or less"
        )
    # The mean over the record; single time stamps are rounded.
    return float(f"{(time[-1] - time[0]) / (len(time) - 1):.9g}")


def require_excitation(name: str, pressure: Samples, step: float) -> None:
    """Raise UnsuitableRecordError if a pressure hardly varies.

    It must turn a few times by a tenth of its range: one rise or fall does not identify three poles.
    """
    span = float(np.ptp(pressure))
    if span < _SMALLEST_SPAN:
        raise UnsuitableRecordError(f"no excitation: {name!r} varies by {span / BAR:.3g} bar only")
    every = max(round(_SPACING / step), 1)
    swings = len(runs(pressure[::every], _SWING * span))
    if swings < _FEWEST_SWINGS:
        raise UnsuitableRecordError(
            f"too little excitation: {name!r} swings {swings} times by a tenth of its range,"
            f" {_FEWEST_SWINGS} times are needed"
        )


def held_out(count: int, share: float) -> Mask:
    """Return which samples are excluded from the fit: segments spread over the whole record."""
    number = np.arange(count) * _SEGMENTS // count
    return np.asarray(np.floor((number + 1) * share) > np.floor(number * share))


_AT_REST = 0.02
"""Pressure below which a brake is released, share of the largest pressure; chosen."""
_REST = 0.5
"""Time in s for which it must be; chosen."""
_TURNING = 0.05
"""Change back after which the pressure counts as turned, share of its range; chosen."""
_APPLICATION_SPACING = 0.01
"""Time in s between the samples in which turns are looked for; chosen."""


def applications(tank: Samples, cylinder: Samples, step: float) -> list[slice]:
    """Return the segments of a record for the cylinder dynamics, each started at rest.

    A release at the end of a segment is excluded: air then leaves through the brake line, past the WSP
    valve's vent, and no stop contains it. A record that never rests is one segment.
    """
    released = np.maximum(tank, cylinder) < _AT_REST * max(tank.max(), cylinder.max())
    edges = np.flatnonzero(np.diff(released.astype(int)))
    bounds = [0, *(edges + 1).tolist(), len(tank)]
    rests = [
        (first, end) for first, end in pairwise(bounds) if released[first] and (end - first) * step >= _REST
    ]
    if not rests:
        return [slice(0, len(tank))]
    starts = [0, *(end for _, end in rests)] if rests[0][0] > 0 else [end for _, end in rests]
    ends = [first for first, _ in rests if first > 0] + [len(tank)]
    return [
        slice(max(start - 1, 0), end if end == len(tank) else _before_release(tank, start, end, step))
        for start, end in zip(starts, ends, strict=True)
        if end > start
    ]


def _before_release(tank: Samples, start: int, end: int, step: float) -> int:
    """Sample at which the last fall before ``end`` begins."""
    every = max(round(_APPLICATION_SPACING / step), 1)
    thinned = tank[start:end:every]
    turns = runs(thinned, _TURNING * float(np.ptp(thinned)))
    return start + every * turns[-1][0] if turns and turns[-1][2] < 0 else end
