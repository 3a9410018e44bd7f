"""Which way a loop is run through."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

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
