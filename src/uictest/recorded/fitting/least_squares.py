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
        covariance: of them; neighbouring residuals that agree count less.
        cost: half the sum of the squares, in units of the noise; outliers count less.
        significance: by how much the cost must rise for values to lie outside the 95 % confidence.
        noise: standard deviation of each group.
        quantile: standard deviations of the half width of a 95 % confidence interval.
        residual: standard deviation of all residuals.
        misfit: minus the logarithm of the likelihood if residuals were independent, up to a constant.
        dependence: how many residuals count as one.
    """

    values: Array
    covariance: Array
    cost: float
    significance: float
    noise: tuple[float, ...]
    quantile: float
    residual: float
    misfit: float
    dependence: float

    @property
    def half_widths(self) -> list[float]:
        """Half widths of the 95 % confidence intervals."""
        return [float(self.quantile * np.sqrt(v)) for v in np.diag(self.covariance)]


def solve(
    residuals: Callable[[Array], Groups],
    start: Array,
    bounds: Bounds,
    noise: Sequence[float] | None = None,
    known: Callable[[Array], Array] | None = None,
    steps: int = _MOST_STEPS,
) -> Solution:
    """Return the unknowns with the least sum of squares.

    Args:
        residuals: of the unknowns; every call returns groups of the same lengths.
        start: of the unknowns; its sizes are their scales.
        bounds: lowest and highest values.
        noise: standard deviation of each group; None: estimated by a first pass.
        known: by how many standard deviations unknowns differ from what is known of them beforehand.
        steps: after which either pass ends, however far it has come.
    """
    if noise is None:
        first = _minimum(residuals, start, bounds, None, known, steps)
        start, noise = first.x, noise_of(residuals(first.x))
    found = _minimum(residuals, start, bounds, noise, known, steps)
    return _solution(found, residuals(found.x), tuple(noise))


def noise_of(residuals: Groups) -> tuple[float, ...]:
    """Return the standard deviation of each group."""
    return tuple(max(float(np.std(group)) if len(group) > 2 else 1.0, 1e-6) for group in residuals)


def _minimum(
    residuals: Callable[[Array], Groups],
    start: Array,
    bounds: Bounds,
    noise: Sequence[float] | None,
    known: Callable[[Array], Array] | None,
    steps: int,
) -> Any:
    """Return scipy's solution, in units of the noise if it is known."""
    from scipy.optimize import least_squares

    outlier = _FIRST_OUTLIER if noise is None else _OUTLIER

    def scaled(x: Array) -> Array:
        groups = residuals(x)
        each = [1.0] * len(groups) if noise is None else noise
        parts = [group / size for group, size in zip(groups, each, strict=True)]
        if known is not None:
            parts.append(known(x) * (outlier / _OUTLIER))
        return np.concatenate(parts)

    scale = np.maximum(np.abs(start), 1e-3)
    return least_squares(
        scaled, start, bounds=bounds, loss="soft_l1", f_scale=outlier, x_scale=scale, max_nfev=steps
    )


def _solution(found: Any, residuals: Groups, noise: tuple[float, ...]) -> Solution:
    from scipy.stats import t as student

    freedom = max(len(found.fun) - len(found.x), 1)
    variance = 2.0 * found.cost / freedom * _inflation(max(residuals, key=len))
    sizes = np.array([len(group) for group in residuals])
    quantile = float(student.ppf(0.5 * (1.0 + _CONFIDENCE), freedom))
    return Solution(
        found.x,
        np.linalg.pinv(found.jac.T @ found.jac) * variance,
        float(found.cost),
        0.5 * quantile**2 * variance,
        noise,
        quantile,
        float(np.std(np.concatenate(residuals))),
        float(sizes @ np.log(noise_of(residuals))),
        max(variance, 1.0),
    )


def _inflation(residuals: Array) -> float:
    """Return how many residuals count as one, because neighbours agree."""
    if len(residuals) <= 3 or np.std(residuals) == 0.0:
        return 1.0
    repeated = float(np.clip(np.corrcoef(residuals[1:], residuals[:-1])[0, 1], 0.0, 0.9))
    return (1.0 + repeated) / (1.0 - repeated)
