"""Friction of the rail, and optionally of the pads, by least squares on the balances of a stop."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from uictest.field_data import RecordedStop
from uictest.fitting.balances import Balances, windows_of
from uictest.fitting.samples import FitError, samples_of
from uictest.scenario import Scenario

Array = NDArray[np.float64]
Residuals = tuple[Array, Array]
"""Of the balances of sliding wheelsets, and of the train."""
Standing = Literal["found", "at least", "not reached"]

_LOWEST, _HIGHEST = 0.001, 1.0
"""Friction coefficients that a scenario accepts."""
_FEWEST = 4
"""Windows of sliding in a stretch below which its friction is not determined; chosen."""
_START_SHARE = 1.15
"""Friction to begin with, over the largest adhesion used; chosen."""
_BOUND_PERCENTILE = 95.0
"""Of the adhesion used while rolling, taken as the lower bound: single windows are noise; chosen."""
_CONFIDENCE = 0.95
_FIRST_OUTLIER = 0.01
"""Residual from which it counts less than by its square, as long as the noise is unknown; chosen."""
_OUTLIER = 3.0
"""Standard deviations from which a residual counts less than by its square; chosen."""


@dataclass(frozen=True, slots=True)
class Estimate:
    """One quantity: its value and the half width of its 95 % confidence interval, or why there is none.

    `at least`: nothing slid there, so that the value is only a lower bound. `not reached`: no wheelset came
    there. `windows` counts the windows that determine it.
    """

    name: str
    standing: Standing
    value: float
    half_width: float
    windows: int

    def __str__(self) -> str:
        """Return the estimate for a reader."""
        if self.standing == "not reached":
            return f"{self.name}: no wheelset came there"
        if self.standing == "at least":
            return f"{self.name}: at least {self.value:.4f}; nothing slid there, so it may be higher"
        share = 100.0 * self.half_width / self.value
        return f"{self.name}: {self.value:.4f} +- {self.half_width:.4f} ({share:.1f} %, 95 % confidence)"


@dataclass(frozen=True, slots=True)
class Fit:
    """Result of a fit: friction per stretch, the factor on the pads' friction, and the residual.

    `residual` is the standard deviation of the balances' residuals, as an adhesion coefficient.
    """

    breaks: tuple[float, ...]
    friction: tuple[Estimate, ...]
    pad_factor: Estimate | None
    residual: float

    @property
    def determined(self) -> bool:
        """Whether every friction that a wheelset met is determined."""
        return all(estimate.standing != "at least" for estimate in self.friction)


def fit_stop(
    stop: RecordedStop,
    scenario: Scenario,
    breaks: Sequence[float] = (),
    *,
    with_pads: bool = False,
) -> Fit:
    """Return the friction of the rail on which a recorded stop of a scenario's vehicle was made.

    Args:
        stop: the recorded stop; train and wheel speeds, and clamping forces or torques where there are any.
        scenario: vehicle, brake, gradient and the other parameters of the creep law.
        breaks: places between stretches of constant friction, m from the brake command, rising.
        with_pads: fit a factor on the scenario's pad friction as well; needs clamping forces.

    Raises:
        FitError: the record lacks what is needed.

    """
    samples = samples_of(stop, scenario)
    balances = Balances(samples, windows_of(samples), scenario)
    if with_pads and samples.torque is None:
        raise FitError("pad friction cannot be fitted: the clamping forces of all wheelsets are not recorded")
    return _fit(balances, breaks, with_pads=with_pads)


def _fit(balances: Balances, breaks: Sequence[float], *, with_pads: bool) -> Fit:
    stretch = stretch_of(balances.samples.place, breaks)
    counts = _windows_of_sliding(balances, stretch, len(breaks) + 1)
    free = [k for k, count in enumerate(counts) if count >= _FEWEST]
    values, spread, residual = _solve(balances, stretch, free, len(breaks) + 1, with_pads=with_pads)
    names = stretch_names(breaks)
    friction = []
    for k, name in enumerate(names):
        if k in free:
            friction.append(
                Estimate(f"friction {name}", "found", values[free.index(k)], spread[free.index(k)], counts[k])
            )
        else:
            friction.append(_lower_bound(balances, stretch, k, f"friction {name}"))
    pads = None
    if with_pads:
        pads = Estimate(
            "factor on pad friction", "found", values[-1], spread[-1], len(balances.windows.first)
        )
    return Fit(tuple(breaks), tuple(friction), pads, residual)


def _windows_of_sliding(balances: Balances, stretch: NDArray[np.intp], stretches: int) -> list[int]:
    middle = (balances.windows.first + balances.windows.last) // 2
    where = stretch[:, middle]
    return [int((balances.windows.sliding & (where == k)).sum()) for k in range(stretches)]


def _lower_bound(balances: Balances, stretch: NDArray[np.intp], number: int, name: str) -> Estimate:
    middle = (balances.windows.first + balances.windows.last) // 2
    there = stretch[:, middle] == number
    if not there.any():
        return Estimate(name, "not reached", float("nan"), float("nan"), 0)
    used = balances.adhesion_used()[there & ~balances.windows.standing]
    bound = max(float(np.percentile(used, _BOUND_PERCENTILE)), _LOWEST) if len(used) else _LOWEST
    return Estimate(name, "at least", bound, float("nan"), int(there.sum()))


def _solve(
    balances: Balances, stretch: NDArray[np.intp], free: list[int], stretches: int, *, with_pads: bool
) -> tuple[list[float], list[float], float]:
    """Return the free frictions and the factor, their half widths, and the residual's standard deviation."""

    def residuals(x: Array) -> Residuals:
        level = np.full(stretches, _HIGHEST)
        level[free] = x[: len(free)]
        factor = float(x[-1]) if with_pads else 1.0
        friction = level[stretch]
        return balances.wheelset_residuals(friction, factor), balances.train_residuals(friction, factor)

    start = _start(balances, len(free), with_pads=with_pads)
    if not len(start):
        known = balances.samples.torque is not None
        return [], [], float(np.std(np.concatenate(residuals(start)))) if known else float("nan")
    solution = _least_squares(residuals, start, _bounds(len(free), with_pads=with_pads))
    final = residuals(solution.x)
    return list(map(float, solution.x)), _half_widths(solution, final), float(np.std(np.concatenate(final)))


def _least_squares(
    residuals: Callable[[Array], Residuals], start: Array, bounds: tuple[list[float], list[float]]
) -> Any:
    """Return scipy's solution of the second of two passes; the first estimates the noise of each balance."""
    from scipy.optimize import least_squares

    unknown = (1.0, 1.0)
    noise = unknown
    for _ in range(2):
        solution = least_squares(
            lambda x, s=noise: np.concatenate([r / each for r, each in zip(residuals(x), s, strict=True)]),
            start,
            bounds=bounds,
            loss="soft_l1",
            f_scale=_FIRST_OUTLIER if noise == unknown else _OUTLIER,
            x_scale=start,
        )
        start = solution.x
        wheelsets, train = map(_noise, residuals(start))
        noise = wheelsets, train
    return solution


def _noise(residuals: Array) -> float:
    return max(float(np.std(residuals)) if len(residuals) > 2 else 1.0, 1e-6)


def _start(balances: Balances, count: int, *, with_pads: bool) -> Array:
    used = balances.adhesion_used()[balances.windows.sliding]
    begin = float(np.clip(_START_SHARE * np.median(used), 0.01, 0.9)) if len(used) else 0.1
    return np.array([begin] * count + [1.0] * with_pads)


def _bounds(count: int, *, with_pads: bool) -> tuple[list[float], list[float]]:
    return [_LOWEST] * count + [0.2] * with_pads, [_HIGHEST] * count + [5.0] * with_pads


def _half_widths(solution: Any, residuals: tuple[Array, Array]) -> list[float]:
    """Return half widths of the 95 % confidence intervals; neighbouring windows that agree count less."""
    from scipy.stats import t as student

    freedom = max(len(solution.fun) - len(solution.x), 1)
    variance = 2.0 * solution.cost / freedom
    covariance = np.linalg.pinv(solution.jac.T @ solution.jac) * variance
    longest = max(residuals, key=len)
    inflation = 1.0
    if len(longest) > 3 and np.std(longest) > 0.0:
        repeated = float(np.clip(np.corrcoef(longest[1:], longest[:-1])[0, 1], 0.0, 0.9))
        inflation = (1.0 + repeated) / (1.0 - repeated)
    quantile = float(student.ppf(0.5 * (1.0 + _CONFIDENCE), freedom))
    return [float(quantile * np.sqrt(inflation * v)) for v in np.diag(covariance)]


def stretch_of(place: Array, breaks: Sequence[float]) -> NDArray[np.intp]:
    """Return the number of the stretch, from 0, in which each place (m) lies; `breaks` in rising order, m."""
    return np.searchsorted(np.asarray(breaks, dtype=np.float64), place, side="right")


def stretch_names(breaks: Sequence[float]) -> list[str]:
    """Return the name of each stretch, as in "from 50 m to 120 m"."""
    if not breaks:
        return ["everywhere"]
    ends = [f"{place:g} m" for place in breaks]
    inner = [f"from {a} to {b}" for a, b in pairwise(ends)]
    return [f"up to {ends[0]}", *inner, f"from {ends[-1]} on"]
