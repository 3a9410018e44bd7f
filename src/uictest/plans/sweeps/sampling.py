"""Points of the unit cube, each a function of seed and number alone: points can be computed in any order."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uictest.plans.sweeps.model import Method

Points = NDArray[np.float64]
_BLOCK = 1024
"""Points of one random stream: each block has its own generator, so that any point takes few draws."""


def points(method: Method, size: int, dimensions: int, seed: int, numbers: NDArray[np.int64]) -> Points:
    """Return the points of a sample with the given numbers (from 0), shape (numbers, dimensions).

    `size` counts points; for `saltelli` each of them makes (dimensions + 2) rows: see :func:`_saltelli`.
    """
    if not numbers.size:
        return np.empty((0, dimensions))
    if method == "saltelli":
        return _saltelli(dimensions, seed, numbers)
    if method == "sobol":
        return _sobol(dimensions, seed, numbers)
    if method == "latin-hypercube":
        return _latin_hypercube(size, dimensions, seed)[numbers]
    return _random(dimensions, seed, numbers)


def _random(dimensions: int, seed: int, numbers: NDArray[np.int64]) -> Points:
    blocks, within = numbers // _BLOCK, numbers % _BLOCK
    drawn = np.empty((numbers.size, dimensions))
    for block in np.unique(blocks):
        rows = blocks == block
        generator = np.random.Generator(np.random.Philox(np.random.SeedSequence([seed, int(block)])))
        drawn[rows] = generator.random((_BLOCK, dimensions))[within[rows]]
    return drawn


def _sobol(dimensions: int, seed: int, numbers: NDArray[np.int64]) -> Points:
    first, last = int(numbers.min()), int(numbers.max())
    return _sobol_run(dimensions, seed, first, last + 1 - first)[numbers - first]


def _sobol_run(dimensions: int, seed: int, first: int, count: int) -> Points:
    from scipy.stats import qmc

    engine: Any = qmc.Sobol(dimensions, scramble=True, rng=seed)
    if first == 0:
        # scipy warns if the size of the first draw is not a power of two.
        count = 1 << (count - 1).bit_length()
    else:
        engine.fast_forward(first)
    drawn: Points = engine.random(count)
    return drawn


@lru_cache(maxsize=1)
def _latin_hypercube(size: int, dimensions: int, seed: int) -> Points:
    """Return the whole design, which has every stratum of every parameter once."""
    from scipy.stats import qmc

    design: Points = qmc.LatinHypercube(dimensions, rng=seed).random(size)
    return design


def _saltelli(dimensions: int, seed: int, numbers: NDArray[np.int64]) -> Points:
    """Rows of Saltelli's scheme: per base point one of A, one of B, one of A for each parameter taken from B.

    A and B are the halves of one Sobol sequence in twice the dimensions.
    """
    rows = dimensions + 2
    both = _sobol(2 * dimensions, seed, numbers // rows)
    role = numbers % rows
    drawn = np.where((role == 1)[:, None], both[:, dimensions:], both[:, :dimensions])
    for parameter in range(dimensions):
        swapped = role == parameter + 2
        drawn[swapped, parameter] = both[swapped, dimensions + parameter]
    return drawn
