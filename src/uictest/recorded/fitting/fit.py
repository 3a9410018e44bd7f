"""The friction of the rail under one recorded stop."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from uictest.plans.scenario import Scenario
from uictest.recorded.field_data import RecordedStop
from uictest.recorded.fitting.balances import Balances, windows_of
from uictest.recorded.fitting.least_squares import Groups, Solution, in_a_row, solve
from uictest.recorded.fitting.samples import FitError, samples_of
from uictest.recorded.fitting.stretches import HIGHEST, LOWEST, Estimate, RailUnderStop, Stretches

Array = NDArray[np.float64]
COVERED: Final = (
    "the 95 % interval covers noise and delay of the speeds, at the vehicle's wheel loads, not the"
    " calibration of sensors, masses, pads or brake"
)
_LARGEST_MISFIT = 0.015
"""Share of a friction; chosen: on simulated rails 0 to 0.3 % of one, 4 to 9 % where sliding cleans."""
_CONFIDENCE = 0.99
"""With which something is left beyond the noise; chosen."""
_LONGEST_DELAY = 0.1
"""s; chosen, less than half a window."""


@dataclass(frozen=True, slots=True)
class Fit:
    """Result of a fit: friction per stretch, the factor on the pads' friction, and what they leave.

    Args:
        breaks: places between the stretches, m from the brake command.
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
        return [*self.friction, *(each for each in (self.delay, self.pad_factor) if each is not None)]

    @property
    def describes_rail(self) -> bool:
        """Whether the rail is as these values say, as far as the noise shows it."""
        return not self.misfit > _LARGEST_MISFIT

    @property
    def remark(self) -> str:
        """That these values do not describe the rail, or that noise may hide it; else empty."""
        if not self.describes_rail:
            left = f"{100.0 * self.misfit:.1f} % of the friction is left beyond the noise of the speeds"
            return f"{left}: sliding cleans the rail, or it varies"
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
        breaks: places between stretches of constant friction, m from the brake command, rising.
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
    solution = _solve(RailUnderStop(stretches), with_pads=with_pads)
    values, half_widths = list(map(float, solution.values)), solution.half_widths
    groups, count = solution.residuals[:2], len(stretches.free)

    def found(name: str, place: int) -> Estimate:
        return Estimate(name, "found", values[place], half_widths[place], windows)

    friction = stretches.estimates(values[:count], half_widths[:count])
    delay = found("delay of the wheel speeds, s", count) if count else None
    pads = found("factor on pad friction", -1) if with_pads else None
    left = np.concatenate(groups)
    residual = float(np.std(left)) if len(left) else float("nan")
    shares = _left(balances, groups, float(np.mean(values[:count]))) if count else (0.0, 0.0)
    return Fit(tuple(breaks), friction, pads, residual, delay, *shares)


def _solve(rail: RailUnderStop, *, with_pads: bool) -> Solution:
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


def _left(balances: Balances, residuals: Groups, friction: float) -> tuple[float, float]:
    """Return the shares of a friction that are left at least beyond the noise, and that noise leaves."""
    from scipy.stats import chi2

    largest = max(residuals, key=len)
    row, variance = in_a_row(largest)
    noise = balances.noise_variance(row) if largest is residuals[1] else 0.0
    freedom = 1.5 * len(largest) / row
    least = variance * freedom / float(chi2.ppf(_CONFIDENCE, freedom))
    return float(np.sqrt(max(least - noise, 0.0))) / friction, float(np.sqrt(noise)) / friction
