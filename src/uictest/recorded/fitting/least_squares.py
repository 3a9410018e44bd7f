"""Robust least squares on groups of residuals, each with its own noise."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Groups = Sequence[Array]
"""Residuals, one array for each group of the same noise."""
Bounds = tuple[list[float], list[float]]

_CONFIDENCE = 0.95
_FIRST_OUTLIER = 0.01
"""Residual from which it counts less than by its square, as long as the noise is unknown; chosen."""
_OUTLIER = 3.0
"""Standard deviations from which a residual counts less than by its square; chosen."""
_MOST_STEPS = 100
"""Where the misfit hardly depends on an unknown, more lead nowhere; chosen."""


@dataclass(frozen=True, slots=True, eq=False)
class Solution:
    """What least squares found.

    Args:
        values: of the unknowns.
        half_widths: of their 95 % confidence intervals; neighbouring residuals that agree count less.
        residual: standard deviation of all residuals.
    """

    values: Array
    half_widths: list[float]
    residual: float


def solve(residuals: Callable[[Array], Groups], start: Array, bounds: Bounds) -> Solution:
    """Return the unknowns with the least sum of squares; the noise is estimated by a first pass.

    Args:
        residuals: of the unknowns; every call returns groups of the same lengths.
        start: of the unknowns; its sizes are their scales.
        bounds: lowest and highest values.
    """
    first = _minimum(residuals, start, bounds, None)
    found = _minimum(residuals, first.x, bounds, _noise_of(residuals(first.x)))
    return _solution(found, residuals(found.x))


def _noise_of(residuals: Groups) -> list[float]:
    """Return the standard deviation of each group."""
    return [max(float(np.std(group)) if len(group) > 2 else 1.0, 1e-6) for group in residuals]


def _minimum(
    residuals: Callable[[Array], Groups], start: Array, bounds: Bounds, noise: Sequence[float] | None
) -> Any:
    """Return scipy's solution, in units of the noise if it is known."""
    from scipy.optimize import least_squares

    outlier = _FIRST_OUTLIER if noise is None else _OUTLIER

    def scaled(x: Array) -> Array:
        groups = residuals(x)
        each = [1.0] * len(groups) if noise is None else noise
        return np.concatenate([group / size for group, size in zip(groups, each, strict=True)])

    scale = np.maximum(np.abs(start), 1e-3)
    return least_squares(
        scaled, start, bounds=bounds, loss="soft_l1", f_scale=outlier, x_scale=scale, max_nfev=_MOST_STEPS
    )


def _solution(found: Any, residuals: Groups) -> Solution:
    from scipy.stats import t as student

    freedom = max(len(found.fun) - len(found.x), 1)
    variance = 2.0 * found.cost / freedom * _inflation(max(residuals, key=len))
    quantile = float(student.ppf(0.5 * (1.0 + _CONFIDENCE), freedom))
    covariance = np.linalg.pinv(found.jac.T @ found.jac) * variance
    half_widths = [float(quantile * np.sqrt(v)) for v in np.diag(covariance)]
    return Solution(found.x, half_widths, float(np.std(np.concatenate(residuals))))


def _inflation(residuals: Array) -> float:
    """Return how many residuals count as one, because neighbours agree."""
    if len(residuals) <= 3 or np.std(residuals) == 0.0:
        return 1.0
    repeated = float(np.clip(np.corrcoef(residuals[1:], residuals[:-1])[0, 1], 0.0, 0.9))
    return (1.0 + repeated) / (1.0 - repeated)
