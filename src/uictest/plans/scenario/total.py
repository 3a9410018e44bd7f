"""Sums that have the same bits on every Python, of numbers and of ensembles of numbers."""

import functools
import operator
from collections.abc import Iterable


def total(numbers: Iterable[float]) -> float:
    """Return the sum, added up from the left. From Python 3.12 on, `sum` rounds numbers otherwise."""
    return functools.reduce(operator.add, numbers, 0.0)
