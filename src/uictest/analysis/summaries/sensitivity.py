"""First-order and total Sobol indices of a Saltelli sample: how much each parameter affects a measure."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.plans.sweeps import Plan, saltelli_sample
from uictest.report import SobolIndex, SobolSensitivity, WrittenValue

Numbers = NDArray[np.float64]
_RESAMPLES: Final = 200
_CONFIDENCE: Final = 0.95
_WIDE: Final = 0.2
"""Width of a confidence interval above which a note says so: chosen."""


def uncertainty_note(sensitivities: Sequence[SobolSensitivity]) -> str:
    """Return a note if the sample is too small for the indices of a measure, else an empty text."""
    widest = max(
        (index.uncertainty for each in sensitivities for index in (each.first, each.total)), default=0.0
    )
    if widest <= _WIDE:
        return ""
    return (
        f"sensitivity of {sensitivities[0].measure}: intervals are up to {widest:.2f} wide; a sample of "
        "four times the size halves them"
    )


def sobol_sensitivities(
    plan: Plan, measure: str, values: NDArray[np.float64]
) -> tuple[list[SobolSensitivity], str]:
    """Return the indices of a measure, and the reason where there are none.

    Args:
        plan: plan of a Saltelli sample.
        measure: name of the measure.
        values: the measure for every case of the plan.
    """
    sample = saltelli_sample(plan)
    assert sample is not None
    missing = np.count_nonzero(~np.isfinite(values))
    if missing:
        return [], f"{missing} of {values.size} cases have no {measure}"
    sensitivities: list[SobolSensitivity] = []
    for number, in_sample in enumerate(values.reshape(-1, sample.size)):
        if np.ptp(in_sample) == 0.0:
            return [], f"{measure} is the same in all cases"
        first_case = plan.settings(np.array([number * sample.size]))
        listed = {
            key: WrittenValue(column[0].text) for key, column in first_case.items() if key not in sample.keys
        }
        firsts, totals = _sobol_indices(in_sample.reshape(sample.points, -1), sample.seed)
        sensitivities.extend(
            SobolSensitivity(measure, listed, key, first, total)
            for key, first, total in zip(sample.keys, firsts, totals, strict=True)
        )
    return sensitivities, ""


def _sobol_indices(rows: Numbers, seed: int) -> tuple[list[SobolIndex], list[SobolIndex]]:
    """Return first-order and total indices; `rows` holds base points: A, B, A with one column of B."""
    low, high = confidence_interval(_index_estimates, rows, seed)
    first, total = np.stack([_index_estimates(rows), low, high], axis=-1).tolist()
    return [SobolIndex(*each) for each in first], [SobolIndex(*each) for each in total]


def confidence_interval(
    estimate: Callable[[Numbers], Numbers], rows: Numbers, seed: int
) -> tuple[Numbers, Numbers]:
    """Return the ends of the 95 % confidence interval of an estimate from rows: percentile bootstrap."""
    generator = np.random.default_rng(seed)
    points = rows.shape[0]
    resampled = np.array([estimate(rows[generator.integers(0, points, points)]) for _ in range(_RESAMPLES)])
    outside = 0.5 * (1.0 - _CONFIDENCE)
    low, high = np.nanquantile(resampled, [outside, 1.0 - outside], axis=0)
    return low, high


def _index_estimates(rows: Numbers) -> Numbers:
    """Return the indices of all parameters, shape (2, parameters): first order, total."""
    from scipy.stats import sobol_indices

    if np.ptp(rows) == 0.0:
        return np.full((2, rows.shape[1] - 2), np.nan)
    functions: Any = {"f_A": rows[:, 0][None], "f_B": rows[:, 1][None], "f_AB": rows[:, 2:].T[:, None]}
    result = sobol_indices(func=functions, n=rows.shape[0])
    return np.stack([np.ravel(result.first_order), np.ravel(result.total_order)])
