"""Lines through samples as SVG path data, and which way a loop is run through."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from uictest.report.traces.trace import Samples, extremes

_COLUMN = (
    3.0  # pixels: a drawing is shown larger or smaller than it is written, and lines are wider than this
)


def path_over_time(x: Samples, y: Samples) -> str:
    """Return the path of a series over time (both in pixels); where y is missing the line has a gap.

    Of every column only the extremes are kept, in their order, so that no peak is lost.
    """
    kept = extremes(np.floor(x / _COLUMN), y)
    return path(x[kept], y[kept])


def path(x: Samples, y: Samples) -> str:
    """Return the path through points in pixels, rounded to whole ones; a missing one leaves a gap."""
    known = np.isfinite(x) & np.isfinite(y)
    ends = np.flatnonzero(np.diff(known, prepend=False, append=False))
    return "".join(_stroke(x[start:end], y[start:end]) for start, end in ends.reshape(-1, 2).tolist())


def dots(x: Samples, y: Samples) -> str:
    """Return the path of single points in pixels, each drawn once; it needs round ends to be seen."""
    known = np.isfinite(x) & np.isfinite(y)
    points = np.unique(np.rint(np.column_stack([x[known], y[known]])).astype(np.int64), axis=0)
    return "".join([f"M{across} {up}h0" for across, up in points.tolist()])


def _stroke(x: Samples, y: Samples) -> str:
    points = np.rint(np.column_stack([x, y])).astype(np.int64)
    steps = np.diff(points, axis=0)
    steps = steps[steps.any(axis=1)]
    start = f"M{points[0, 0]} {points[0, 1]}"
    return start + "".join([_step(across, up) for across, up in steps.tolist()])


def _step(across: int, up: int) -> str:
    if up == 0:
        return f"h{across}"
    return f"v{up}" if across == 0 else f"l{across} {up}"


REVERSAL = 0.02
"""Of the range: a quantity that comes back by less has not turned; chosen above the noise of a pressure."""

Pieces = list[tuple[int, int, int]]
"""First and last row of each piece, and 1 where the quantity rises in it, -1 where it falls."""


def pieces(x: NDArray[np.float64]) -> Pieces:
    """Return the pieces of a series between its turning points; each begins where the one before ends."""
    known = x[np.isfinite(x)]
    least = REVERSAL * float(np.ptp(known)) if len(known) else 0.0
    found: Pieces = []
    direction, start, turned = 1, 0, 0
    values = x.tolist()
    for k, value in enumerate(values):
        if direction * (value - values[turned]) >= 0.0:
            turned = k
        elif direction * (values[turned] - value) > least:
            if turned > start:
                found.append((start, turned, direction))
            direction, start, turned = -direction, turned, k
    return [*found, (start, len(values) - 1, direction)] if len(values) > start + 1 else found
