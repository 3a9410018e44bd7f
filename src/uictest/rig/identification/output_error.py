"""Poles and weights that fit a record: a linear start, then refinement of the output error.

They are those of a third-order transfer function, stable and of unity gain at rest by its parametrisation,

    H(s) = 1 + c1 (1/(1 + T s) - 1) + (c2 + c3 alpha s)/(1 + alpha s + beta s^2) - c2,   T, alpha, beta > 0

held at the sampling time (zero-order hold). The section of second order has real or complex poles. For
given poles the output is linear in c1, c2 and c3.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uictest.rig.identification.lines import Mask, Samples

Poles = NDArray[np.float64]
"""Logarithms of T in s, alpha in s and beta in s^2."""
Weigh = Callable[[Samples, Samples, Callable[[], Samples]], tuple[float, Samples]]
ErrorFunction = Callable[[Poles], tuple[float, Samples]]
_SLOWEST, _FASTEST = 20.0, 2.0
"""Slowest time constant in s, and fastest in sampling times: what a record of seconds can tell; chosen."""
_LARGEST_PRODUCT = 10.0
"""Largest product of the three time constants in s^3; chosen."""
_STIEGLITZ_ROUNDS = 5
"""Rounds of the linear start; chosen."""
LARGEST_TURN = 1e-4
"""By how much the response to a unit step may overshoot, or fall from one of the following times to the next.
The hysteresis keeps the largest pressure as force; chosen."""
_RESPONSE_TIMES = 100
_LONGEST_RESPONSE = 60.0
"""Number of times at which the step response is bounded, and the last of them in s; chosen."""
_SMALLEST_SIZE = 1e-10
"""Singular value of the columns below which they are dependent, share of the largest; chosen."""
_TIME_CONSTANTS = (0.02, 0.05, 0.13, 0.33, 0.85, 2.2, 5.5)
_DAMPINGS = (0.4, 0.8, 1.2, 3.0)
_GRID_STARTS = 3
"""Time constants in s and dampings of the grid of starts, and how many of its points are followed; chosen."""
_COARSE_POINTS, _POINTS = 4000, 40_000
"""Points at which errors are computed, in the first search and in the refinement; chosen."""
_COARSE_EVALUATIONS, _EVALUATIONS = 150, 120
"""Most evaluations of the error, in the first search and in the refinement; chosen."""
_COARSE_STEP = 0.005
"""Sampling time in s of the first search; the dynamics of tanks take tenths of seconds; chosen."""
_LINEAR_STEP = 0.02
"""Sampling time in s of the linear start; chosen."""


def sections(poles: Poles, step: float) -> list[tuple[Samples, Samples]]:
    """Numerator and denominator of the three held sections: lag, low pass and band pass."""
    time_constant, alpha, beta = np.exp(poles)
    decay = np.exp(-step / time_constant)
    scale = np.sqrt(beta)
    # State: the low pass and scale x its rate; the input, held, is the third.
    rates = np.array(
        [[0.0, 1.0 / scale, 0.0], [-1.0 / scale, -alpha / beta, 1.0 / scale], [0.0, 0.0, 0.0]], dtype=float
    )
    held = _exponential(rates * step)
    transition, driven = held[:2, :2], held[:2, 2]
    trace = transition[0, 0] + transition[1, 1]
    denominator = np.array([1.0, -trace, np.exp(-step * alpha / beta)])
    later = transition @ driven - trace * driven
    low = np.array([0.0, driven[0], later[0]])
    band = np.array([0.0, driven[1], later[1]]) * (alpha / scale)
    lag = np.array([0.0, 1.0 - decay]), np.array([1.0, -decay])
    return [lag, (low, denominator), (band, denominator)]


def _exponential(matrix: Samples) -> Samples:
    """Matrix exponential of a small matrix: Taylor's series, scaled and squared; scipy's costs far more."""
    squarings = max(int(np.ceil(np.log2(max(np.abs(matrix).sum(axis=1).max(), 1e-300)))) + 2, 0)
    scaled = matrix / 2.0**squarings
    term = total = np.eye(len(matrix))
    for n in range(1, 14):
        term = term @ scaled / n
        total = total + term
    for _ in range(squarings):
        total = total @ total
    return np.asarray(total)


def basis(samples: Samples, held: Sequence[tuple[Samples, Samples]], at: NDArray[np.intp]) -> Samples:
    """Three columns at some of the samples; the output is the input plus their sum weighted by c1, c2, c3.

    Args:
        samples: of the input.
        held: its :func:`sections`.
        at: where the columns are wanted.
    """
    from scipy.signal import lfilter

    lag, low, band = (lfilter(b, a, samples)[at] for b, a in held)
    return np.stack([lag - samples[at], low - samples[at], band], axis=1)


def free_weights(columns: Samples, target: Samples, response: Callable[[], Samples]) -> tuple[float, Samples]:
    """Return the least root-mean-square error and its weights, whatever the step response."""
    weights = np.asarray(np.linalg.lstsq(columns, target, rcond=_SMALLEST_SIZE)[0], dtype=np.float64)
    return float(np.sqrt(np.mean((target - columns @ weights) ** 2))), weights


def bounded_weights(
    columns: Samples, target: Samples, response: Callable[[], Samples]
) -> tuple[float, Samples]:
    """Return the least root-mean-square error and its weights among those whose step response never falls.

    Args:
        columns: what the weights multiply, shape (n, 3).
        target: shape (n,).
        response: gives what they multiply in the response to a unit step, less one, shape (m, 3).
    """
    left, sizes, right = np.linalg.svd(columns, full_matrices=False)
    kept = sizes > _SMALLEST_SIZE * sizes[0]
    scale = max(float(np.linalg.norm(target)), np.finfo(float).tiny)
    weights_of = right[kept].T / sizes[kept] * scale
    # In these coordinates the error grows with the distance from the free optimum.
    free = left[:, kept].T @ target / scale
    rising = response()
    slopes = np.concatenate([-rising[:1], rising, -np.diff(rising, axis=0)]) @ weights_of
    limits = np.concatenate([[1.0], np.full(len(slopes) - 1, LARGEST_TURN)])
    weights = np.asarray(weights_of @ _nearest(free, slopes, limits), dtype=np.float64)
    return float(np.sqrt(np.mean((target - columns @ weights) ** 2))), weights


def _nearest(point: Samples, slopes: Samples, limits: Samples) -> Samples:
    """Return the point nearest to ``point`` where ``slopes @ x <= limits``, which zero satisfies."""
    from scipy.optimize import minimize

    if np.all(slopes @ point <= limits):
        return point
    within = {"type": "ineq", "fun": lambda x: limits - slopes @ x, "jac": lambda x: -slopes}
    return np.asarray(
        minimize(
            lambda x: float((x - point) @ (x - point)),
            np.zeros_like(point),
            jac=lambda x: 2.0 * (x - point),
            method="SLSQP",
            constraints=within,
        ).x
    )


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
    segments: Sequence[FitSegment], step: float, weigh: Weigh = bounded_weights
) -> tuple[Poles, Samples]:
    """Poles and weights with the least error of the simulated output where it is fitted.

    The weights follow from the poles (variable projection), so that three unknowns remain. The best poles of
    a grid and those of a linear fit are followed at a coarse sampling time, first without and then with
    bounds on the step response; the best end is refined at the record's own sampling time. With
    `free_weights` nothing bounds the step response.
    """
    coarse = max(round(_COARSE_STEP / step), 1)
    thinned = [each.thinned(coarse) for each in segments]
    span = max(float(np.ptp(each.input)) for each in segments)
    free = _error_function(thinned, coarse * step, free_weights, _COARSE_POINTS)
    starts = _starts(max(segments, key=lambda each: len(each.input)), step, free)
    ends = [_local_minimum(free, start, _COARSE_EVALUATIONS, span) for start in starts]
    coarse_error = _error_function(thinned, coarse * step, weigh, _COARSE_POINTS)
    ends = [_local_minimum(coarse_error, end, _COARSE_EVALUATIONS, span) for end in ends]
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
    times = np.unique(np.geomspace(1.0, _LONGEST_RESPONSE / step, _RESPONSE_TIMES).astype(int)) - 1
    unit_step = np.ones(times[-1] + 1)

    def error(poles: Poles) -> tuple[float, Samples]:
        held = sections(bounded(poles, step), step)
        columns = [basis(each.input, held, at) for each, at in zip(segments, chosen, strict=True)]
        return weigh(np.concatenate(columns), target, lambda: basis(unit_step, held, times))

    return error


def _local_minimum(error: ErrorFunction, start: Poles, evaluations: int, span: float) -> Poles:
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


def _starts(longest: FitSegment, step: float, error: ErrorFunction) -> list[Poles]:
    grid = [
        np.log([lag, 2.0 * damping * section, section * section])
        for lag in _TIME_CONSTANTS
        for section in _TIME_CONSTANTS
        for damping in _DAMPINGS
    ]
    best = sorted(grid, key=lambda poles: error(poles)[0])[:_GRID_STARTS]
    linear = _linear_start(longest.input, longest.output, step)
    return best if linear is None else [*best, linear]


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
