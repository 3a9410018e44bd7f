"""The friction of the rail under one recorded stop."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uictest.plans.scenario import Scenario
from uictest.recorded.field_data import RecordedStop
from uictest.recorded.fitting.balances import Balances, windows_of
from uictest.recorded.fitting.least_squares import Bounds, Groups, solve
from uictest.recorded.fitting.samples import FitError, samples_of
from uictest.recorded.fitting.stretches import (
    HIGHEST,
    LOWEST,
    Estimate,
    RailUnderStop,
    Stretches,
)

Array = NDArray[np.float64]


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
    def estimates(self) -> list[Estimate]:
        """What was fitted: the friction of every stretch, then the factor on the pads' friction."""
        return [*self.friction, *([] if self.pad_factor is None else [self.pad_factor])]

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
    values, half_widths, residual = _solve(RailUnderStop(stretches), with_pads=with_pads)
    count = len(stretches.free)
    pads = None
    if with_pads:
        pads = Estimate("factor on pad friction", "found", values[-1], half_widths[-1], windows)
    return Fit(tuple(breaks), stretches.estimates(values[:count], half_widths[:count]), pads, residual)


def _solve(rail: RailUnderStop, *, with_pads: bool) -> tuple[list[float], list[float], float]:
    """Return the free frictions and the factor, their half widths, and the residual's standard deviation."""
    count, balances = len(rail.free), rail.stretches.balances

    def residuals(x: Array) -> Groups:
        return balances.residuals(*rail.met(x[:count]), float(x[-1]) if with_pads else 1.0)

    start = np.array(rail.stretches.start + [1.0] * with_pads)
    if not len(start):
        left = np.concatenate(residuals(start))
        known = balances.samples.torque is not None and len(left) > 0
        return [], [], float(np.std(left)) if known else float("nan")
    solution = solve(residuals, start, _bounds(count, with_pads=with_pads))
    return list(map(float, solution.values)), solution.half_widths, solution.residual


def _bounds(count: int, *, with_pads: bool) -> Bounds:
    return [LOWEST] * count + [0.2] * with_pads, [HIGHEST] * count + [5.0] * with_pads
