"""The fit of the cleaning of the rail to recorded stops, and the friction of each of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from uictest.plans.scenario import Cleaning, RailCondition, Scenario, load_part
from uictest.recorded.field_data import RecordedStop
from uictest.recorded.fitting.balances import Balances, windows_of
from uictest.recorded.fitting.cleaned_stop import CleanedStop
from uictest.recorded.fitting.cleaning import CleaningEstimate, JointSolution, find_cleaning
from uictest.recorded.fitting.estimate import Fit, fit_balances
from uictest.recorded.fitting.samples import FitError, samples_of
from uictest.recorded.fitting.stretches import RailUnderStop, Stretches

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
        samples = samples_of(stop, scenario)
    except FitError as error:
        raise FitError(f"recording {number}: {error}" if count > 1 else str(error)) from error
    return Balances(samples, windows_of(samples), scenario)


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
    kept = {"reach": stated.reach.text, "carry_over": stated.carry_over.text}
    return Cleaning.model_validate({**values, **kept})


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
