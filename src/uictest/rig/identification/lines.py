"""A robust straight line through recorded points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uictest.rig.identification.arrays import Samples

_FEWEST_POINTS = 10
"""Points that a line needs; chosen."""
_NORMAL_MAD = 1.4826
"""Standard deviation of a normal distribution over its median absolute deviation."""
_NORMAL_95_PERCENT = 1.96
"""Half-width of the 95 % interval of a normal distribution over its standard deviation."""
_ROUNDS = 4
"""Rounds in which the noise is estimated; chosen."""
_SMALLEST_SCALE = 1e-6
"""Smallest scale of the scaled forces, so that nothing is divided by zero; chosen."""


@dataclass(frozen=True, slots=True)
class FittedLine:
    """Clamping force over gauge pressure: slope in N/Pa, intercept in N, with 95 % confidence half-widths."""

    slope: float
    intercept: float
    slope_confidence: float = 0.0
    intercept_confidence: float = 0.0
    points: int = 0

    def force(self, pressure: Samples) -> Samples:
        """Force in N at gauge pressures in Pa, never negative."""
        return np.maximum(self.slope * pressure + self.intercept, 0.0)

    def pressure(self, force: float) -> float:
        """Gauge pressure in Pa at a force > 0 in N."""
        return (force - self.intercept) / self.slope


def robust_line(pressure: Samples, force: Samples) -> FittedLine:
    """Fit force = slope x pressure + intercept with the loss soft_l1.

    Points that a phase detector let through by mistake lie to one side of the line, inside the loop. Least
    squares would follow them; soft_l1 counts them by their distance alone beyond the noise, which is
    estimated from the median residual. Unlike Theil-Sen's pairs it is fast on thousands of points and gives
    a covariance.

    Raises:
        ValueError: fewer than ten points, or all at one pressure.
    """
    from scipy.optimize import least_squares

    if len(pressure) < _FEWEST_POINTS or np.ptp(pressure) <= 0.0:
        raise ValueError(f"{len(pressure)} points do not make a line")
    centre, width, height = pressure.mean(), pressure.std(), max(force.std(), _SMALLEST_SCALE)
    x, y = (pressure - centre) / width, (force - force.mean()) / height
    line = np.polyfit(x, y, 1)
    # The first estimate of the noise includes the outliers that its line followed; each round improves it.
    for _ in range(_ROUNDS):
        scale = max(_NORMAL_MAD * float(np.median(np.abs(y - np.polyval(line, x)))), _SMALLEST_SCALE)
        solution = least_squares(lambda fit: fit[0] * x + fit[1] - y, line, loss="soft_l1", f_scale=scale)
        line = solution.x
    covariance = np.linalg.inv(solution.jac.T @ solution.jac) * 2.0 * solution.cost / (len(x) - 2)
    spread = _NORMAL_95_PERCENT * np.sqrt(np.diag(covariance))
    slope = solution.x[0] * height / width
    at_zero = -centre / width
    intercept = force.mean() + height * (solution.x[1] + solution.x[0] * at_zero)
    intercept_spread = np.hypot(spread[1], spread[0] * at_zero)
    return FittedLine(
        float(slope),
        float(intercept),
        float(spread[0] * height / width),
        float(intercept_spread * height),
        len(x),
    )
