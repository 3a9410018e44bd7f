"""Flow through the orifices of the independent rig."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

_ANR_DENSITY: Final = 1.185
_ANR_TEMPERATURE: Final = 293.15


@dataclass(frozen=True, slots=True)
class Orifice:
    """An orifice by ISO 6358: its critical pressure ratio, and that above which the flow is linear."""

    critical: float
    laminar: float

    def __call__(self, p1: Any, p2: Any, t1: Any, t2: Any, conductance: Any) -> Any:
        """Return the mass flow from side 1 to side 2 by ISO 6358, linear near equal pressures, kg/s."""
        high, low = np.maximum(p1, p2), np.minimum(p1, p2)
        warmth, b = np.where(p1 >= p2, t1, t2), self.critical
        quotient = low / high
        at_limit = math.sqrt(1.0 - max((self.laminar - b) / (1.0 - b), 0.0) ** 2)
        near = at_limit * (1.0 - quotient) / (1.0 - self.laminar)
        sonic = np.maximum((np.minimum(quotient, self.laminar) - b) / (1.0 - b), 0.0)
        share = np.where(quotient > self.laminar, near, np.sqrt(1.0 - sonic**2))
        size = conductance * _ANR_DENSITY * high * share * np.sqrt(_ANR_TEMPERATURE / warmth)
        return np.where(p1 >= p2, size, -size)
