"""The friction of the rail under one recorded stop, in stretches, by robust least squares on its balances."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any, Final, Literal

import numpy as np
from numpy.typing import NDArray

from uictest import rig
from uictest.plans.scenario import Scenario
from uictest.recorded.field_data import RecordedStop
from uictest.recorded.fitting.balances import Balances, FitError, samples_of, windows_of

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
    minimum = _least_squares(residuals, start, bounds, [1.0] * len(residuals(start)), _FIRST_OUTLIER)
    for _ in range(_PASSES):
        groups = residuals(minimum.x)
        noise = [max(float(np.std(group)) if len(group) > 2 else 1.0, 1e-6) for group in groups]
        minimum = _least_squares(residuals, minimum.x, bounds, noise, _OUTLIER)
    return _solution_with_intervals(minimum, residuals(minimum.x))


def _least_squares(
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


def _solution_with_intervals(minimum: Any, residuals: Groups) -> Solution:
    from scipy.stats import t as student

    freedom = max(len(minimum.fun) - len(minimum.x), 1)
    largest = max(residuals, key=len)
    single = max(float(np.var(largest)), 1e-30)
    row, of_mean = in_a_row(largest)
    variance = 2.0 * minimum.cost / freedom * row * of_mean / single
    quantile = float(student.ppf(0.5 * (1.0 + _CONFIDENCE), freedom))
    covariance = np.linalg.pinv(minimum.jac.T @ minimum.jac) * variance
    half_widths = [float(quantile * np.sqrt(v)) for v in np.diag(covariance)]
    return Solution(minimum.x, half_widths, residuals)


def in_a_row(residuals: Array) -> tuple[int, float]:
    """Return the number of consecutive residuals whose mean is tested, and the variance of that mean.

    The noise of a speed ends one window and begins the next, so that it hardly stays in such a mean; what the
    unknowns do not describe stays.
    """
    rest, row = residuals - np.mean(residuals), min(_IN_A_ROW, max(len(residuals) // _ROWS, 1))
    single = float(rest @ rest)
    shared = sum((1.0 - k / row) * float(rest[k:] @ rest[:-k]) for k in range(1, row))
    return row, max(single + 2.0 * shared, single / row) / (row * len(rest))


Standing = Literal["found", "at least", "not reached"]

LOWEST, HIGHEST = 0.001, 1.0
"""Friction coefficients that a scenario accepts."""
_FEWEST = 4
"""Windows of sliding in a stretch below which its friction is not determined; chosen."""
_START_SHARE = 1.15
"""Friction to begin with, over the largest adhesion used; chosen."""
_BOUND_PERCENTILE = 95.0
"""Of the adhesion used while rolling, taken as the lower bound: single windows are noise; chosen."""


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
        share = 100.0 * self.half_width / abs(self.value)
        return f"{self.name}: {self.value:.4f} +- {self.half_width:.4f} ({share:.1f} %, 95 % confidence)"


@dataclass(frozen=True, slots=True, eq=False)
class Stretches:
    """The rail under a stop in stretches between `breaks`, m from the brake command, rising."""

    balances: Balances
    breaks: tuple[float, ...]

    @property
    def number(self) -> NDArray[np.intp]:
        """Number of the stretch under each wheelset at each sample, from 0, (4, n)."""
        return stretch_of(self.balances.samples.position, self.breaks)

    @property
    def counts(self) -> list[int]:
        """Windows of sliding in each stretch."""
        sliding, where = self.balances.windows.sliding, self._number_in_windows
        if self.balances.samples.torque is None:  # The train alone tells, where all slide.
            sliding = sliding & sliding.all(axis=0)
        return [int((sliding & (where == k)).sum()) for k in range(len(self.breaks) + 1)]

    @property
    def free(self) -> list[int]:
        """The stretches whose friction the stop determines."""
        return [k for k, count in enumerate(self.counts) if count >= _FEWEST]

    @property
    def start(self) -> list[float]:
        """A friction to begin with for each of the free stretches."""
        used = self.balances.adhesion_used()[self.balances.windows.sliding]
        begin = float(np.clip(_START_SHARE * np.median(used), 0.01, 0.9)) if len(used) else 0.1
        return [begin] * len(self.free)

    def estimates(self, values: Sequence[float], half_widths: Sequence[float]) -> tuple[Estimate, ...]:
        """Return the friction of every stretch; values and half widths are those of the free ones."""
        fitted = dict(zip(self.free, zip(values, half_widths, strict=True), strict=True))
        counts = self.counts
        return tuple(
            Estimate(f"friction {name}", "found", *fitted[k], counts[k])
            if k in fitted
            else self._lower_bound(k, f"friction {name}")
            for k, name in enumerate(stretch_names(self.breaks))
        )

    @property
    def _number_in_windows(self) -> NDArray[np.intp]:
        windows = self.balances.windows
        return self.number[:, (windows.first + windows.last) // 2]

    def _lower_bound(self, number: int, name: str) -> Estimate:
        there = self._number_in_windows == number
        if not there.any():
            return Estimate(name, "not reached", float("nan"), float("nan"), 0)
        used = self.balances.adhesion_used()[there & ~self.balances.windows.standing]
        bound = max(float(np.percentile(used, _BOUND_PERCENTILE)), LOWEST) if len(used) else LOWEST
        return Estimate(name, "at least", bound, float("nan"), int(there.sum()))


def stretch_of(position: Array, breaks: Sequence[float]) -> NDArray[np.intp]:
    """Return the number of the stretch, from 0, in which each position (m) lies; `breaks` rise, m."""
    return np.searchsorted(np.asarray(breaks, dtype=np.float64), position, side="right")


def stretch_names(breaks: Sequence[float]) -> list[str]:
    """Return the name of each stretch, as in "from 50 m to 120 m"."""
    if not breaks:
        return ["everywhere"]
    ends = [f"{position:g} m" for position in breaks]
    inner = [f"from {a} to {b}" for a, b in pairwise(ends)]
    return [f"up to {ends[0]}", *inner, f"from {ends[-1]} on"]


class RailUnderStop:
    """The rail under a stop whose balances are drawn, for any friction of it."""

    def __init__(self, stretches: Stretches) -> None:
        self.stretches = stretches
        self.free = stretches.free
        self._number = stretches.number
        balances = stretches.balances
        s = balances.samples
        self._cleaned = None
        if balances.scenario.rail.cleaning_in_force is not None:
            self._cleaned = rig.RecordedRail(balances.scenario, s.time, s.speed, s.position, s.load, s.slip)

    def met(self, levels: Array) -> tuple[Array, Array | None]:
        """Return friction and cleaned share under each wheelset, (4, n), by the friction of the free ones."""
        every = np.full(len(self.stretches.breaks) + 1, HIGHEST)
        every[self.free] = levels
        friction = np.asarray(every[self._number])
        return (friction, None) if self._cleaned is None else self._cleaned.met(friction)


COVERED: Final = (
    "the 95 % interval covers noise and delay of the speeds, at the vehicle's wheel loads, not the"
    " calibration of sensors, masses, pads or brake"
)
_LARGEST_MISFIT = 0.015
"""Share of a friction; chosen: on simulated rails 0 to 0.3 % of one, 4 to 9 % where sliding cleans."""
_CONFIDENCE_OF_MISFIT = 0.99
"""With which something is left beyond the noise; chosen."""
_LONGEST_DELAY = 0.1
"""s; chosen, less than half a window."""


@dataclass(frozen=True, slots=True)
class Fit:
    """Result of a fit: friction per stretch, the factor on the pads' friction, and what they leave.

    Args:
        breaks: positions between the stretches, m from the brake command.
        friction: of every stretch.
        pad_factor: None where it is not fitted.
        residual: standard deviation of the balances' residuals, as an adhesion coefficient.
        delay: by which the wheel speeds are recorded later than the train speed, s; None without sliding.
        misfit: share of the friction that these values leave at least, beyond the noise.
        hidden: share that the noise leaves.
    """

    breaks: tuple[float, ...]
    friction: tuple[Estimate, ...]
    pad_factor: Estimate | None
    residual: float
    delay: Estimate | None = None
    misfit: float = 0.0
    hidden: float = 0.0

    @property
    def estimates(self) -> list[Estimate]:
        """What was fitted: the friction of every stretch, the delay, the factor on the pads' friction."""
        return [*self.friction, *(number for number in (self.delay, self.pad_factor) if number is not None)]

    @property
    def describes_rail(self) -> bool:
        """Whether the rail is as these values say, as far as the noise shows it."""
        return not self.misfit > _LARGEST_MISFIT

    @property
    def remark(self) -> str:
        """That these values do not describe the rail, or that noise may hide it; else empty."""
        if not self.describes_rail:
            misfit = f"{100.0 * self.misfit:.1f} % of the friction is left beyond the noise of the speeds"
            return f"{misfit}: sliding cleans the rail, or it varies"
        if self.hidden > _LARGEST_MISFIT:
            return f"the noise may hide that it varies by {100.0 * self.hidden:.1f} %"
        return ""

    @property
    def determined(self) -> bool:
        """Whether every friction that a wheelset met is determined."""
        return all(estimate.standing != "at least" for estimate in self.friction)


def fit_stop(
    stop: RecordedStop, scenario: Scenario, breaks: Sequence[float] = (), *, with_pads: bool = False
) -> Fit:
    """Return the friction of the rail on which a recorded stop of a scenario's vehicle was made.

    Args:
        stop: the recorded stop; train and wheel speeds, and clamping forces or torques where there are any.
        scenario: vehicle, brake, gradient, the other parameters of the creep law, and how sliding cleans the
            rail, if it does.
        breaks: positions between stretches of constant friction, m from the brake command, rising.
        with_pads: fit a factor on the scenario's pad friction as well; needs clamping forces.

    Raises:
        FitError: the record lacks what is needed, or is too short.

    """
    if with_pads and scenario.brake.pad.varies:
        raise FitError("pad friction that varies cannot be fitted: write brake.pad: constant")
    if with_pads and any(own.pad_friction is not None for own in scenario.vehicle.wheelsets.values()):
        raise FitError("one factor cannot stand for pads of single wheelsets: leave out their pad_friction")
    samples = samples_of(stop, scenario)
    if with_pads and samples.torque is None:
        raise FitError("pad friction cannot be fitted: the clamping forces of all wheelsets are not recorded")
    balances = Balances(samples, windows_of(samples), scenario)
    windows = len(balances.windows.first)
    if not windows:
        raise FitError("the stop is too short for a fit")
    stretches = Stretches(balances, tuple(breaks))
    solution = _solve_frictions(RailUnderStop(stretches), with_pads=with_pads)
    values, half_widths = list(map(float, solution.values)), solution.half_widths
    groups, count = solution.residuals[:2], len(stretches.free)

    def estimate(name: str, index: int) -> Estimate:
        return Estimate(name, "found", values[index], half_widths[index], windows)

    friction = stretches.estimates(values[:count], half_widths[:count])
    delay = estimate("delay of the wheel speeds, s", count) if count else None
    pads = estimate("factor on pad friction", -1) if with_pads else None
    residuals = np.concatenate(groups)
    residual = float(np.std(residuals)) if len(residuals) else float("nan")
    shares = _unexplained_shares(balances, groups, float(np.mean(values[:count]))) if count else (0.0, 0.0)
    return Fit(tuple(breaks), friction, pads, residual, delay, *shares)


def _solve_frictions(rail: RailUnderStop, *, with_pads: bool) -> Solution:
    """Return the free frictions, the delay of the wheel speeds, and the factor."""
    count, balances = len(rail.free), rail.stretches.balances
    samples = balances.samples
    # Where nothing else says so, speeds of one record are taken within an interval of each other.
    usual_delay = float(samples.time[1] - samples.time[0]) / 3.0**0.5

    def residuals(x: Array) -> Groups:
        shifted = replace(balances, samples=samples.without_delay(x[count]))
        groups = shifted.residuals(*rail.met(x[:count]), float(x[-1]) if with_pads else 1.0)
        return *groups, x[count : count + 1] / usual_delay

    start = np.array([*rail.stretches.start, 0.0, *[1.0] * with_pads])
    lowest = [LOWEST] * count + [-_LONGEST_DELAY] + [0.2] * with_pads
    return solve(residuals, start, (lowest, [HIGHEST] * count + [_LONGEST_DELAY] + [5.0] * with_pads))


def _unexplained_shares(balances: Balances, residuals: Groups, friction: float) -> tuple[float, float]:
    """Return the residual beyond the noise (lower bound) and the noise, as shares of a friction."""
    from scipy.stats import chi2

    largest = max(residuals, key=len)
    row, variance = in_a_row(largest)
    noise = balances.noise_variance(row) if largest is residuals[1] else 0.0
    freedom = 1.5 * len(largest) / row
    least = variance * freedom / float(chi2.ppf(_CONFIDENCE_OF_MISFIT, freedom))
    return float(np.sqrt(max(least - noise, 0.0))) / friction, float(np.sqrt(noise)) / friction
