"""Which parameters of a sweep are spaced or drawn logarithmically."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from uictest.plans.sweeps import Group, ListedGroup, Plan
from uictest.report import WrittenValue

_MOST_UNEVEN: Final = 1.5
"""Largest over smallest logarithm of the ratios of neighbours: 1, 2, 5, 10 have 1.32. Chosen."""
_MORE_EVEN: Final = 1.6
"""So many times more uneven the differences must be than these logarithms. Chosen."""


def logarithmic_keys(plan: Plan) -> tuple[str, ...]:
    """Return the keys that are drawn log-uniformly, or whose listed numbers rise or fall by like ratios."""
    return tuple(key for group in plan.groups for key in _logarithmic_in(group))


def _logarithmic_in(group: Group) -> Iterator[str]:
    for place, key in enumerate(group.keys):
        if isinstance(group, ListedGroup):
            chosen = spaced_logarithmically([row[place].text for row in group.rows])
        else:
            chosen = group.draws[place].distribution.log_uniform is not None
        if chosen:
            yield key


def spaced_logarithmically(texts: Sequence[str]) -> bool:
    """Return whether values as written are at least three numbers of one unit in like ratios."""
    values = [WrittenValue(text) for text in dict.fromkeys(texts)]
    numbers = np.array([value.number for value in values], float)
    if len(values) < 3 or len({value.unit for value in values}) > 1 or not np.all(numbers > 0.0):
        return False
    differences, ratios = np.diff(numbers), np.diff(np.log(numbers))
    if not (np.all(ratios > 0.0) or np.all(ratios < 0.0)):
        return False
    unevenness = _unevenness(ratios)
    return unevenness <= _MOST_UNEVEN and _unevenness(differences) >= _MORE_EVEN * unevenness


def _unevenness(steps: NDArray[np.float64]) -> float:
    return float(np.abs(steps).max() / np.abs(steps).min())
