"""From numbers between 0 and 1 to values of a distribution."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from uictest.sweep.model import Distribution, Normal

Shares = NDArray[np.float64]
Quantile = Callable[[Shares], NDArray[np.float64]]


def quantile(distribution: Distribution) -> Quantile:
    """Return the function that turns shares (0 up to 1) into numbers, in the unit of the distribution.

    A choice gives the places of its values, from 0.
    """
    if distribution.choice is not None:
        return _place(len(distribution.choice))
    if distribution.normal is not None:
        return _cut_off_normal(distribution.normal)
    amounts = distribution.uniform or distribution.log_uniform or distribution.triangular
    assert amounts is not None
    numbers = [float(amount.number) for amount in amounts]
    if distribution.log_uniform is not None:
        return _log_uniform(*numbers)
    return _triangular(*numbers) if distribution.triangular is not None else _uniform(*numbers)


def _place(count: int) -> Quantile:
    return lambda shares: np.minimum(np.floor(shares * count), count - 1.0)


def _uniform(low: float, high: float) -> Quantile:
    return lambda shares: np.clip(low + shares * (high - low), low, high)


def _log_uniform(low: float, high: float) -> Quantile:
    return lambda shares: np.clip(low * np.exp(shares * math.log(high / low)), low, high)


def _triangular(low: float, mode: float, high: float) -> Quantile:
    span, below = high - low, mode - low

    def at(shares: Shares) -> NDArray[np.float64]:
        rising = low + np.sqrt(shares * span * below)
        falling = high - np.sqrt((1.0 - shares) * span * (high - mode))
        return np.clip(np.where(shares < below / span, rising, falling), low, high)

    return at


def _cut_off_normal(normal: Normal) -> Quantile:
    from scipy.special import ndtr, ndtri

    mean, deviation, low, high = (
        float(amount.number) for amount in (normal.mean, normal.deviation, normal.lower, normal.upper)
    )
    first, last = (ndtr((end - mean) / deviation) for end in (low, high))
    return lambda shares: np.clip(mean + deviation * ndtri(first + shares * (last - first)), low, high)
