"""Stops one after the other on the same rail, which keeps what the wheels of earlier ones have cleaned."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from studies.stop_runner import StopRunner, measured
from uictest import Case, CaseResult

if TYPE_CHECKING:
    from studies.study import Table

STOPS = 6
_STANDARD_GRAVITY: Final = 9.80665
_KILOJOULE: Final = 1000.0


@dataclass(frozen=True, slots=True)
class UsedRail:
    """Stops on one rail under one seed, in their order.

    Attributes:
        found: friction that the first wheelset finds in each, before it slides.
        spent: contact loss per metre of all wheelsets of the stops before each, J/m.
        stops: the stops.
    """

    found: Sequence[float]
    spent: Sequence[float]
    stops: Sequence[CaseResult]

    @property
    def distances(self) -> list[float]:
        """Braking distance of every stop, m."""
        return [measured(stop, "braking_distance_m") for stop in self.stops]

    @property
    def adhesions(self) -> list[float]:
        """Mean deceleration of every stop, g."""
        return [measured(stop, "mean_deceleration_mps2") / _STANDARD_GRAVITY for stop in self.stops]


Used = Mapping[tuple[str, str], Sequence[UsedRail]]
"""By law and controller, one per seed."""


def used_rail(stop_runner: StopRunner, scenario: str, changes: Mapping[str, str], seed: int) -> UsedRail:
    """Stop again and again on a rail that is cleaned; each stop meets the loss of all before as `spent`.

    The loss of a stop is spread evenly over its distance, and later stops are shorter: they lie within it.
    """
    found, spent, stops = [], [0.0], []
    for _ in range(STOPS):
        worn = {"rail.condition.cleaning.spent": f"{spent[-1]:.9g} J/m"} if spent[-1] else {}
        (case,) = stop_runner.cases(scenario, {**changes, **worn})
        ((stop,),) = (each.stops for each in stop_runner.repeated([case], [seed]))
        found.append(_friction_found(case))
        stops.append(stop)
        spent.append(spent[-1] + loss_per_metre(stop))
    return UsedRail(found, spent[:-1], stops)


def loss_per_metre(stop: CaseResult) -> float:
    """Return what all wheelsets of a stop lost to their contacts, over its braking distance, J/m."""
    lost = sum(each["contact_energy_kj"] for each in stop.wheelsets) * _KILOJOULE
    return lost / measured(stop, "braking_distance_m")


def _friction_found(case: Case) -> float:
    rail = case.scenario.rail
    cleaning, friction = rail.cleaning_in_force, rail.friction
    assert cleaning is not None
    assert isinstance(friction, float)
    gain = max(cleaning.recovered_friction - friction, 0.0)
    return float(friction + cleaning.clean_part(cleaning.carry_over * cleaning.spent_share) * gain)


def used_table(used: Used, seeds: Sequence[int]) -> Table:
    """Return a row for every stop, which the first wheelset begins on the friction that it finds."""
    rows = [
        (law, controller, seed, k, rail)
        for (law, controller), rails in used.items()
        for seed, rail in zip(seeds, rails, strict=True)
        for k in range(STOPS)
    ]
    return {
        "law": [law for law, *_ in rows],
        "controller": [controller for _, controller, *_ in rows],
        "seed": [seed for _, _, seed, *_ in rows],
        "stop": [k + 1 for *_, k, _ in rows],
        "spent_j_per_m": [round(rail.spent[k], 1) for *_, k, rail in rows],
        "friction_found": [round(rail.found[k], 5) for *_, k, rail in rows],
        "distance_m": [round(rail.distances[k], 2) for *_, k, rail in rows],
        "mean_deceleration_g": [round(rail.adhesions[k], 5) for *_, k, rail in rows],
    }
