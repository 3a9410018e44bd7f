"""Units in which studies show what they find."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

BAR = 1e5
KILONEWTON = 1e3
PERCENT = 0.01
KILOMETRE_PER_HOUR = 1.0 / 3.6
KILONEWTON_PER_BAR = KILONEWTON / BAR
STANDARD_AIR = 1.185
"""Density of air at 20 degC and 1 bar, kg/m3 (ISO 8778)."""
LITRE = 1e-3


def shown(samples: NDArray[Any], unit: float, digits: int) -> list[float]:
    """Return samples, SI, in another unit, rounded as they are written to files."""
    rounded: list[float] = np.round(samples / unit, digits).tolist()
    return rounded
