"""The friction of the rail under one recorded stop, or under several with how sliding cleans it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uictest.plans.scenario import Cleaning, RailCondition, Scenario, load_part
from uictest.recorded.field_data import RecordedStop
from uictest.recorded.fitting.balances import Balances, windows_of
from uictest.recorded.fitting.cleaning import CleaningEstimate, JointSolution, find_cleaning
from uictest.recorded.fitting.least_squares import Bounds, Groups, solve
from uictest.recorded.fitting.samples import FitError, samples_of
from uictest.recorded.fitting.stretches import (
    HIGHEST,
    LOWEST,
    CleanedStop,
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
        FitError: the record lacks what is needed.

    """
    if with_pads and scenario.brake.pad.varies:
        raise FitError("pad friction that varies cannot be fitted: write brake.pad: constant")
    if with_pads and any(own.pad_friction is not None for own in scenario.vehicle.wheelsets.values()):
        raise FitError("one factor cannot stand for pads of single wheelsets: leave out their pad_friction")
    balances = balances_of(stop, scenario)
    if with_pads and balances.samples.torque is None:
        raise FitError("pad friction cannot be fitted: the clamping forces of all wheelsets are not recorded")
    return fit_balances(balances, breaks, with_pads=with_pads)


def balances_of(stop: RecordedStop, scenario: Scenario) -> Balances:
    """Return the balances of a recorded stop of a scenario's vehicle. Raises FitError as :func:`fit_stop`."""
    samples = samples_of(stop, scenario)
    return Balances(samples, windows_of(samples), scenario)


def fit_balances(balances: Balances, breaks: Sequence[float], *, with_pads: bool) -> Fit:
    """Return the friction under the stop whose balances are given; see :func:`fit_stop`."""
    stretches = Stretches(balances, tuple(breaks))
    values, half_widths, residual = _solve(RailUnderStop(stretches), with_pads=with_pads)
    count = len(stretches.free)
    pads = None
    if with_pads:
        windows = len(balances.windows.first)
        pads = Estimate("factor on pad friction", "found", values[-1], half_widths[-1], windows)
    return Fit(tuple(breaks), stretches.estimates(values[:count], half_widths[:count]), pads, residual)


def _solve(rail: RailUnderStop, *, with_pads: bool) -> tuple[list[float], list[float], float]:
    """Return the free frictions and the factor, their half widths, and the residual's standard deviation."""
    count, balances = len(rail.free), rail.stretches.balances

    def residuals(x: Array) -> Groups:
        return balances.residuals(*rail.met_as_stated(x[:count]), float(x[-1]) if with_pads else 1.0)

    start = np.array(rail.stretches.start + [1.0] * with_pads)
    if not len(start):
        left = np.concatenate(residuals(start))
        known = balances.samples.torque is not None and len(left) > 0
        return [], [], float(np.std(left)) if known else float("nan")
    solution = solve(residuals, start, _bounds(count, with_pads=with_pads))
    return list(map(float, solution.values)), solution.half_widths, solution.residual


def _bounds(count: int, *, with_pads: bool) -> Bounds:
    return [LOWEST] * count + [0.2] * with_pads, [HIGHEST] * count + [5.0] * with_pads


_EXAMPLE = "rails/wet-cleaning"
"""The rail of the library whose numbers are suggested."""
_DIGITS = 4


@dataclass(frozen=True, slots=True)
class CleaningFit:
    """Result of a fit of the cleaning: what it is, and the friction of the rail in each stop.

    `in_force` is the cleaning that the frictions belong to: as found; where both numbers cannot be told
    apart, the recovered friction of the scenario and the energy that belongs to it; where cleaning is not
    seen, that of the scenario, with the least energy that is not contradicted if that is more.
    """

    estimate: CleaningEstimate
    in_force: Cleaning
    stops: tuple[Fit, ...]

    @property
    def determined(self) -> bool:
        """Whether the cleaning and every friction that a wheelset met are determined."""
        return self.estimate.standing == "found" and all(stop.determined for stop in self.stops)


def fit_cleaning(
    stops: Sequence[RecordedStop], scenario: Scenario, breaks: Sequence[float] = ()
) -> CleaningFit:
    """Return how sliding cleaned the rail in recorded stops of a scenario's vehicle, and its friction.

    Args:
        stops: recorded stops, each on a rail of its own friction; the cleaning is common to them.
        scenario: vehicle, brake, gradient, creep law, and reach and carry-over of the cleaning. Its energy
            and recovered friction are where the search begins.
        breaks: places between stretches of constant friction, m from each brake command, rising.

    Raises:
        FitError: the scenario does not clean the rail, or a record lacks what is needed.

    """
    stated = scenario.rail.cleaning_in_force
    if stated is None:
        raise FitError(_no_cleaning())
    balances = [_balances(stop, scenario, k, len(stops)) for k, stop in enumerate(stops, start=1)]
    slid = [CleanedStop(RailUnderStop(each)) for b in balances if (each := Stretches(b, tuple(breaks))).free]
    if not slid:
        nan = float("nan")
        nothing = CleaningEstimate("nothing slid", nan, nan, nan, nan, nan, 0.0)
        return CleaningFit(nothing, stated, _with_cleaning(balances, breaks, stated))
    joint = find_cleaning(slid, float(stated.energy), float(stated.recovered_friction))
    in_force = _in_force(joint.cleaning, stated)
    if joint.cleaning.standing != "found":
        return CleaningFit(joint.cleaning, in_force, _with_cleaning(balances, breaks, in_force))
    return CleaningFit(joint.cleaning, in_force, _as_found(balances, breaks, joint))


def _no_cleaning() -> str:
    rail = load_part(_EXAMPLE)
    assert isinstance(rail, RailCondition)
    assert rail.cleaning is not None
    c = rail.cleaning
    return (
        "the scenario does not clean the rail, and a fit needs its reach and carry-over: write"
        f" rail.cleaning: {{energy: {c.energy.text}, recovered_friction: {c.recovered_friction.text},"
        f" reach: {c.reach.text}, carry_over: {c.carry_over.text}}}, which are the library's values"
    )


def _balances(stop: RecordedStop, scenario: Scenario, number: int, count: int) -> Balances:
    try:
        return balances_of(stop, scenario)
    except FitError as error:
        raise FitError(f"recording {number}: {error}" if count > 1 else str(error)) from error


def _in_force(found: CleaningEstimate, stated: Cleaning) -> Cleaning:
    """Return the cleaning to simulate with: as found, else with the recovered friction of the scenario."""
    if found.standing == "not seen" and found.energy < stated.energy:
        return stated
    return _changed(stated, found.energy, found.recovered_friction)


def _changed(stated: Cleaning, energy: float, recovered_friction: float) -> Cleaning:
    values = {
        "energy": f"{energy:.{_DIGITS + 1}g} J/m",
        "recovered_friction": f"{recovered_friction:.{_DIGITS}f}",
    }
    required = {"reach": stated.reach.text, "carry_over": stated.carry_over.text}
    found = Cleaning.model_validate({**values, **required})
    # The rest of the law stays as it is stated.
    return stated.model_copy(update={name: getattr(found, name) for name in values})


def _with_cleaning(
    balances: Sequence[Balances], breaks: Sequence[float], cleaning: Cleaning
) -> tuple[Fit, ...]:
    """Return the friction under each stop on a rail that is cleaned in a given way."""
    fits = []
    for each in balances:
        rail = each.scenario.rail.model_copy(update={"cleaning": cleaning})
        scenario = each.scenario.model_copy(update={"rail": rail})
        fits.append(fit_balances(Balances(each.samples, each.windows, scenario), breaks, with_pads=False))
    return tuple(fits)


def _as_found(balances: Sequence[Balances], breaks: Sequence[float], joint: JointSolution) -> tuple[Fit, ...]:
    """Return the friction under each stop as found together with the cleaning."""
    found = iter(zip(joint.levels, joint.half_widths, strict=True))
    fits = []
    for each in balances:
        stretches = Stretches(each, tuple(breaks))
        values, half_widths = next(found) if stretches.free else ([], [])
        fits.append(Fit(tuple(breaks), stretches.estimates(values, half_widths), None, joint.residual))
    return tuple(fits)
