"""Poles and weights that fit a record: a linear start, then refinement of the output error."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uictest.identification.arrays import Mask, Samples
from uictest.identification.transfer_function import Poles, basis

Weigh = Callable[[Samples, Samples], tuple[float, Samples]]
ErrorFunction = Callable[[Poles], tuple[float, Samples]]
_SLOWEST, _FASTEST = 20.0, 2.0
"""Slowest time constant in s, and fastest in sampling times: what a record of seconds can tell; chosen."""
_LARGEST_PRODUCT = 10.0
"""Largest product of the three time constants in s^3; chosen."""
_STIEGLITZ_ROUNDS = 5
_LAWSON_ROUNDS = 40
"""Rounds of the two iterations; chosen."""
_DEFAULT_STARTS = ((0.1, 0.3, 3.0), (0.02, 0.3, 5.0), (0.15, 1.0, 2.5), (0.25, 1.4, 12.0))
"""Time constants in s of the fixed starts; chosen."""
_COARSE_POINTS, _POINTS = 4000, 40_000
"""Points at which errors are computed, in the first search and in the refinement; chosen."""
_COARSE_EVALUATIONS, _EVALUATIONS = 150, 120
"""Most evaluations of the error, in the first search and in the refinement; chosen."""
_COARSE_STEP = 0.005
"""Sampling time in s of the first search; the dynamics of tanks take tenths of seconds; chosen."""
_LINEAR_STEP = 0.02
"""Sampling time in s of the linear start; chosen."""


def least_squares_weights(columns: Samples, target: Samples) -> tuple[float, Samples]:
    """Return the least root-mean-square error and its weights."""
    weights = np.asarray(np.linalg.lstsq(columns, target, rcond=1e-10)[0], dtype=np.float64)
    return float(np.sqrt(np.mean((target - columns @ weights) ** 2))), weights


def least_largest_weights(columns: Samples, target: Samples) -> tuple[float, Samples]:
    """Return the least largest error and its weights, by Lawson's reweighted least squares.

    C. L. Lawson, Contributions to the theory of linear least maximum approximations, thesis, UCLA, 1961.
    """
    emphasis = np.full(len(target), 1.0 / len(target))
    best = np.inf, np.zeros(columns.shape[1])
    for _ in range(_LAWSON_ROUNDS):
        heavy = columns * emphasis[:, None]
        weights = np.linalg.lstsq(heavy.T @ columns, heavy.T @ target, rcond=1e-13)[0]
        error = np.abs(target - columns @ weights)
        largest = float(error.max())
        if largest < best[0]:
            best = largest, weights
        if largest == 0.0:
            break
        # A trace of every point is kept: one that is fitted well now may be the worst in the next round.
        emphasis = emphasis * (error + 1e-6 * largest)
        emphasis /= emphasis.sum()
    return best


@dataclass(frozen=True, slots=True, eq=False)
class FitSegment:
    """Input and output of one segment, at rest at zero at its start, and where the output is fitted."""

    input: Samples
    output: Samples
    fitted: Mask

    def thinned(self, every: int) -> FitSegment:
        """Every so many samples."""
        return FitSegment(self.input[::every], self.output[::every], self.fitted[::every])


def refined(
    segments: Sequence[FitSegment], step: float, weigh: Weigh, first: Poles | None = None
) -> tuple[Poles, Samples]:
    """Poles and weights with the least error of the simulated output where it is fitted.

    The weights follow from the poles (variable projection), so that three unknowns remain. Every
    start (fixed ones, a linear fit and ``first``) is followed on a coarse grid of time, and the best end is
    refined on the record's own.
    """
    coarse = max(round(_COARSE_STEP / step), 1)
    coarse_error = _error_function(
        [each.thinned(coarse) for each in segments], coarse * step, weigh, _COARSE_POINTS
    )
    span = max(float(np.ptp(each.input)) for each in segments)
    starts = [
        *_starts(max(segments, key=lambda each: len(each.input)), step),
        *([] if first is None else [first]),
    ]
    ends = [_local_minimum(coarse_error, start, _COARSE_EVALUATIONS, span) for start in starts]
    best = min(ends, key=lambda poles: coarse_error(poles)[0])
    error = _error_function(segments, step, weigh, _POINTS)
    poles = bounded(_local_minimum(error, best, _EVALUATIONS, span), step)
    return poles, error(poles)[1]


def _error_function(segments: Sequence[FitSegment], step: float, weigh: Weigh, points: int) -> ErrorFunction:
    """Return a function of the poles: the error at a sampling time, and the weights that have it."""
    total = sum(np.count_nonzero(each.fitted) for each in segments)
    every = max(total // points, 1)
    chosen = [np.flatnonzero(each.fitted)[::every] for each in segments]
    target = np.concatenate(
        [(each.output - each.input)[at] for each, at in zip(segments, chosen, strict=True)]
    )

    def error(poles: Poles) -> tuple[float, Samples]:
        within = bounded(poles, step)
        columns = [basis(each.input, within, step)[at] for each, at in zip(segments, chosen, strict=True)]
        return weigh(np.concatenate(columns), target)

    return error


def _local_minimum(error: ErrorFunction, start: Poles, evaluations: int, span: float) -> Poles:
    """Return the poles at which the simplex of Nelder and Mead ends; the largest error has no derivative."""
    from scipy.optimize import minimize

    return np.asarray(
        minimize(
            lambda poles: error(poles)[0],
            start,
            method="Nelder-Mead",
            options={"maxfev": evaluations, "xatol": 1e-3, "fatol": 1e-8 * span},
        ).x
    )


def bounded(poles: Poles, step: float) -> Poles:
    """Poles within what a record can tell and what double precision can hold.

    T, alpha and sqrt(beta) lie between the fastest and the slowest. The gain at rest of equation (8) is a
    quotient of sums that are as small as step^3 / (T beta): beta gives way where T beta would be too large.
    """
    low, high = np.log(_FASTEST * step), np.log(_SLOWEST)
    within = np.clip(poles, [low, low, 2.0 * low], [high, high, 2.0 * high])
    within[2] = min(within[2], np.log(_LARGEST_PRODUCT) - within[0])
    return within


def _starts(longest: FitSegment, step: float) -> Iterator[Poles]:
    yield from (_from_time_constants(constants) for constants in _DEFAULT_STARTS)
    linear = _linear_start(longest.input, longest.output, step)
    if linear is not None:
        yield linear


def _from_time_constants(constants: tuple[float, ...]) -> Poles:
    fast, middle, slow = sorted(constants)
    return np.log([fast, middle + slow, middle * slow])


def _linear_start(tank: Samples, cylinder: Samples, step: float) -> Poles | None:
    """Poles by Steiglitz and McBride's iteration from an ARX fit, on a coarser grid.

    K. Steiglitz and L. E. McBride, A technique for the identification of linear systems, IEEE Trans. Autom.
    Control 10 (1965) 461-464. At the record's own sampling time the poles crowd at one and the equation error
    is all noise. None when a pole is unstable or changes its sign from sample to sample.
    """
    from scipy.signal import lfilter

    coarse = max(round(_LINEAR_STEP / step), 1)
    u, y = (samples[::coarse] - samples[0] for samples in (tank, cylinder))
    denominator = np.array([1.0, 0.0, 0.0, 0.0])
    for _ in range(_STIEGLITZ_ROUNDS):
        uf, yf = lfilter([1.0], denominator, u), lfilter([1.0], denominator, y)
        columns = np.stack([-yf[2:-1], -yf[1:-2], -yf[:-3], uf[3:], uf[2:-1], uf[1:-2], uf[:-3]], axis=1)
        solution = np.linalg.lstsq(columns, yf[3:], rcond=None)[0]
        denominator = np.concatenate([[1.0], solution[:3]])
        roots = np.roots(denominator)
        if np.any(np.abs(roots) >= 1.0):
            return None
    return _from_roots(roots.astype(complex), coarse * step)


def _from_roots(roots: NDArray[np.complex128], step: float) -> Poles | None:
    """One real root as the lag, the others as the section of second order."""
    real = np.flatnonzero(np.abs(roots.imag) < 1e-12)
    if np.any(roots[real].real <= 0.0) or len(real) == 0:
        return None
    rates = -np.log(roots) / step
    lag = real[np.argmax(rates[real].real)]
    first, second = np.delete(rates, lag)
    product = first * second
    return np.log([1.0 / rates[lag].real, ((first + second) / product).real, (1.0 / product).real])
