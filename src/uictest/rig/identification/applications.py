"""Brake applications in a record: segments that begin at rest and end before the brake is released."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from uictest.rig.identification.arrays import Samples
from uictest.rig.identification.phases import runs

_AT_REST = 0.02
"""Pressure below which a brake is released, share of the largest pressure; chosen."""
_REST = 0.5
"""Time in s for which it must be; chosen."""
_TURNING = 0.05
"""Change back after which the pressure counts as turned, share of its range; chosen."""
_SPACING = 0.01
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
    every = max(round(_SPACING / step), 1)
    thinned = tank[start:end:every]
    turns = runs(thinned, _TURNING * float(np.ptp(thinned)))
    return start + every * turns[-1][0] if turns and turns[-1][2] < 0 else end
