"""The four phases in a record: brake-cylinder (BC) or WSP, squeezing or releasing.

A caliper is a play operator: after the pressure turns, the force stays until the other line is reached. A
sample therefore lies on a line only when its force has left the value at which the pressure turned; every
other sample is inside the loop and does not belong to a line.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from uictest.core.physics import FILL
from uictest.rig.identification.arrays import Mask, Samples

TURNING = 0.02
"""Change back after which the pressure counts as turned, share of its range; chosen."""
SETTLING = 0.05
"""Time in s for which the force must have left the inside, as pads settle on the disc; chosen."""
DEPARTURE = 0.03
"""Force by which a sample must have left the loop's inside, share of the largest force; chosen."""
SMOOTHING = 0.02
"""Time in s over which pressure and force are averaged before turns are looked for; chosen."""


def smoothed(samples: Samples, width: int) -> Samples:
    """Centred moving mean over an odd number of samples; the ends are repeated."""
    half = width // 2
    if half == 0:
        return samples
    padded = np.concatenate([np.full(half, samples[0]), samples, np.full(half, samples[-1])])
    sums = np.concatenate([[0.0], np.cumsum(padded)])
    return np.asarray((sums[2 * half + 1 :] - sums[: -2 * half - 1]) / (2 * half + 1))


def runs(pressure: Samples, smallest: float) -> list[tuple[int, int, int]]:
    """Runs (first, end, direction) in which a pressure rises (1) or falls (-1).

    A run ends at its extreme; the pressure has turned once it has come back by ``smallest``.
    """
    segments: list[tuple[int, int, int]] = []
    first = extreme = low = high = 0
    direction = 0
    for n, value in enumerate(pressure):
        if direction >= 0 and value > pressure[high]:
            high = n
        if direction <= 0 and value < pressure[low]:
            low = n
        turned = 0
        if direction >= 0 and value < pressure[high] - smallest:
            turned, extreme = -1, high
        elif direction <= 0 and value > pressure[low] + smallest:
            turned, extreme = 1, low
        if turned:
            if direction != 0:
                segments.append((first, extreme, direction))
            first, direction = extreme, turned
            low = high = n
    if direction != 0:
        segments.append((first, high if direction > 0 else low, direction))
    return segments


def on_lines(pressure: Samples, force: Samples, step: float) -> tuple[Mask, Mask]:
    """Which samples lie on the squeezing and on the releasing line."""
    width = max(round(SMOOTHING / step), 1) | 1
    calm_pressure, calm_force = smoothed(pressure, width), smoothed(force, width)
    margin = DEPARTURE * float(force.max())
    settled = max(round(SETTLING / step), 1)
    earlier = np.concatenate([np.full(settled, calm_force[0]), calm_force[:-settled]])
    squeezing, releasing = np.zeros(len(force), bool), np.zeros(len(force), bool)
    for first, end, direction in runs(calm_pressure, TURNING * float(np.ptp(pressure))):
        inside = calm_force[first]
        run = slice(first + settled, end + 1)
        if direction > 0:
            squeezing[run] = earlier[run] > inside + margin
        else:
            releasing[run] = (earlier[run] < inside - margin) & (calm_force[run] > margin)
    return squeezing, releasing


def wsp_acting_from_commands(time: Samples, commands: Samples, acting_time: float) -> Mask:
    """When the WSP acts: since its last command other than fill, ``acting_time`` s have not passed."""
    last = np.where(commands != FILL, time, -np.inf)
    return np.asarray(time - np.maximum.accumulate(last) < acting_time)


def wsp_acting_in_intervals(time: Samples, intervals: Sequence[tuple[float, float]]) -> Mask:
    """When the WSP acts: in given intervals (first, last) of time in s."""
    acting = np.zeros(len(time), bool)
    for first, last in intervals:
        acting |= (time >= first) & (time <= last)
    return acting
