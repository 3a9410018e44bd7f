"""Which parameter moves a figure how much: first-order and total Sobol indices of a Saltelli sample."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.sweep.plan.plan import Plan, saltelli_sample

Numbers = NDArray[np.float64]
_RESAMPLES: Final = 200
_CONFIDENCE: Final = 0.95
_WIDE: Final = 0.2
"""Width of an interval from which an index says little: chosen."""


@dataclass(frozen=True)
class Index:
    """A Sobol index with the interval that holds it with 95 % confidence (bootstrap over the base points)."""

    value: float
    low: float
    high: float

    @property
    def uncertainty(self) -> float:
        """How wide the interval is."""
        return self.high - self.low


@dataclass(frozen=True)
class Sensitivity:
    """How much one parameter moves one figure, alone and together with all others.

    `circumstances` holds the values of the parameters that were listed, not drawn.
    """

    measure: str
    circumstances: dict[str, str]
    key: str
    first: Index
    total: Index


def doubts(found: Sequence[Sensitivity]) -> str:
    """Return that the sample is too small for the indices of a figure; nothing where it is not."""
    widest = max((index.uncertainty for each in found for index in (each.first, each.total)), default=0.0)
    if widest <= _WIDE:
        return ""
    return (
        f"sensitivity of {found[0].measure}: intervals are up to {widest:.2f} wide; a sample of "
        "four times the size halves them"
    )


def sensitivities(plan: Plan, measure: str, values: NDArray[np.float64]) -> tuple[list[Sensitivity], str]:
    """Return the indices of a figure, and why they are missing where they are.

    Args:
        plan: of a Saltelli sample.
        measure: name of the figure.
        values: the figure for every case of the plan.
    """
    sample = saltelli_sample(plan)
    assert sample is not None
    missing = np.count_nonzero(~np.isfinite(values))
    if missing:
        return [], f"{missing} of {values.size} cases have no {measure}"
    found: list[Sensitivity] = []
    for number, stretch in enumerate(values.reshape(-1, sample.size)):
        if np.ptp(stretch) == 0.0:
            return [], f"{measure} is the same in all cases"
        first = np.array([number * sample.size])
        listed = {
            key: column[0].text for key, column in plan.settings(first).items() if key not in sample.keys
        }
        firsts, totals = _indices(stretch.reshape(sample.points, -1), sample.seed)
        each = zip(sample.keys, firsts, totals, strict=True)
        found.extend(Sensitivity(measure, listed, key, one, all_) for key, one, all_ in each)
    return found, ""


def _indices(rows: Numbers, seed: int) -> tuple[list[Index], list[Index]]:
    """Return first-order and total indices; `rows` holds base points: A, B, A with one column of B."""
    low, high = confidence_interval(_estimate, rows, seed)
    first, total = zip(_estimate(rows).tolist(), low.tolist(), high.tolist(), strict=True)
    return [Index(*each) for each in zip(*first, strict=True)], [
        Index(*each) for each in zip(*total, strict=True)
    ]


def confidence_interval(
    estimate: Callable[[Numbers], Numbers], rows: Numbers, seed: int
) -> tuple[Numbers, Numbers]:
    """Return the ends of the 95 % confidence interval of an estimate from rows: percentile bootstrap."""
    generator = np.random.default_rng(seed)
    points = rows.shape[0]
    again = np.array([estimate(rows[generator.integers(0, points, points)]) for _ in range(_RESAMPLES)])
    outside = 0.5 * (1.0 - _CONFIDENCE)
    low, high = np.nanquantile(again, [outside, 1.0 - outside], axis=0)
    return low, high


def _estimate(rows: Numbers) -> Numbers:
    """Return the indices of all parameters, shape (2, parameters): first order, total."""
    from scipy.stats import sobol_indices

    if np.ptp(rows) == 0.0:
        return np.full((2, rows.shape[1] - 2), np.nan)
    functions: Any = {"f_A": rows[:, 0][None], "f_B": rows[:, 1][None], "f_AB": rows[:, 2:].T[:, None]}
    result = sobol_indices(func=functions, n=rows.shape[0])
    return np.stack([np.ravel(result.first_order), np.ravel(result.total_order)])
