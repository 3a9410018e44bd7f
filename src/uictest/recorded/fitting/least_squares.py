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
_PASSES = 2
"""With the noise of the pass before; chosen: the first, without any, leaves the quiet groups too much."""
_IN_A_ROW, _ROWS = 9, 8
"""Residuals whose mean is looked at, and how many such rows there must be; chosen: 2 s."""


@dataclass(frozen=True, slots=True, eq=False)
class Solution:
    """What least squares found.

    Args:
        values: of the unknowns.
        half_widths: of their 95 % confidence intervals, by the means of residuals in a row.
        residuals: of every group.
    """

    values: Array
    half_widths: list[float]
    residuals: Groups


def solve(residuals: Callable[[Array], Groups], start: Array, bounds: Bounds) -> Solution:
    """Return the unknowns with the least sum of squares; the noise is estimated by the pass before.

    Args:
        residuals: of the unknowns; every call returns groups of the same lengths.
        start: of the unknowns; its sizes are their scales.
        bounds: lowest and highest values.
    """
    found = _minimum(residuals, start, bounds, [1.0] * len(residuals(start)), _FIRST_OUTLIER)
    for _ in range(_PASSES):
        found = _minimum(residuals, found.x, bounds, _noise_of(residuals(found.x)), _OUTLIER)
    return _solution(found, residuals(found.x))


def _noise_of(residuals: Groups) -> list[float]:
    """Return the standard deviation of each group."""
    return [max(float(np.std(group)) if len(group) > 2 else 1.0, 1e-6) for group in residuals]


def _minimum(
    residuals: Callable[[Array], Groups], start: Array, bounds: Bounds, noise: Sequence[float], outlier: float
) -> Any:
    """Return scipy's solution, in units of the noise."""
    from scipy.optimize import least_squares

    def scaled(x: Array) -> Array:
        return np.concatenate([group / size for group, size in zip(residuals(x), noise, strict=True)])

    scale = np.maximum(np.abs(start), 1e-3)
    return least_squares(
        scaled, start, bounds=bounds, loss="soft_l1", f_scale=outlier, x_scale=scale, max_nfev=_MOST_STEPS
    )


def _solution(found: Any, residuals: Groups) -> Solution:
    from scipy.stats import t as student

    freedom = max(len(found.fun) - len(found.x), 1)
    largest = max(residuals, key=len)
    single = max(float(np.var(largest)), 1e-30)
    row, of_mean = in_a_row(largest)
    variance = 2.0 * found.cost / freedom * row * of_mean / single
    quantile = float(student.ppf(0.5 * (1.0 + _CONFIDENCE), freedom))
    covariance = np.linalg.pinv(found.jac.T @ found.jac) * variance
    half_widths = [float(quantile * np.sqrt(v)) for v in np.diag(covariance)]
    return Solution(found.x, half_widths, residuals)


def in_a_row(residuals: Array) -> tuple[int, float]:
    """Return over how many residuals in a row the mean is looked at, and its variance.

    The noise of a speed ends one window and begins the next, so that it hardly stays in such a mean; what the
    unknowns do not describe stays.
    """
    rest, row = residuals - np.mean(residuals), min(_IN_A_ROW, max(len(residuals) // _ROWS, 1))
    single = float(rest @ rest)
    shared = sum((1.0 - k / row) * float(rest[k:] @ rest[:-k]) for k in range(1, row))
    return row, max(single + 2.0 * shared, single / row) / (row * len(rest))
