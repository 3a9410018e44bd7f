"""Where a car ran in its train, and the largest forces in its couplers."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Annotated

from uictest.core.units import with_unit
from uictest.judging.evaluation.json_values import absent_if_empty
from uictest.plans import scenario

WrittenCarFigures = Annotated[scenario.CarFigures, absent_if_empty("implausible")]
"""In JSON the figures of a car list what is implausible only where something is."""

_KILONEWTON = 1e3


@dataclass(frozen=True, slots=True)
class CouplerForces:
    """The largest forces in a coupler during a stop, N; neither is negative."""

    largest_pull_n: float
    largest_push_n: float

    def __str__(self) -> str:
        pull, push = (f"{each / _KILONEWTON:.1f}" for each in (self.largest_pull_n, self.largest_push_n))
        return f"pull {with_unit(pull, 'kN')}, push {with_unit(push, 'kN')}"


@dataclass(frozen=True, slots=True)
class CarInTrain:
    """The place of a car in its train; over several stops of a case the largest forces of all.

    Args:
        train: id of the train.
        car: its number, from 1 for the leading one.
        cars: of the train.
        ahead: forces in the coupler to the car ahead; None for the leading car, and where no stop ended.
        behind: forces in the coupler to the car behind; None for the last car, and where no stop ended.

    """

    train: str
    car: int
    cars: int
    ahead: CouplerForces | None = None
    behind: CouplerForces | None = None

    @property
    def label(self) -> str:
        """The place in words: `car 2 of 4`."""
        return f"car {self.car} of {self.cars}"

    @property
    def couplers(self) -> Iterator[tuple[str, CouplerForces]]:
        """The couplers that it has, `ahead` and `behind`, with their forces."""
        for name, forces in (("ahead", self.ahead), ("behind", self.behind)):
            if forces is not None:
                yield name, forces


def place_in_train(case: scenario.Case) -> CarInTrain | None:
    """Return where the car of a case runs, None for one that runs alone."""
    place = case.train
    return None if place is None else CarInTrain(place.train, place.number, len(place.scenarios))


def over_stops_of_train(places: Sequence[CarInTrain | None]) -> CarInTrain | None:
    """Return the place of a car over several stops of its train, with the largest forces of all."""
    known = [each for each in places if each is not None]
    if not known:
        return None
    return replace(
        known[0],
        ahead=_largest(each.ahead for each in known),
        behind=_largest(each.behind for each in known),
    )


def _largest(forces: Iterable[CouplerForces | None]) -> CouplerForces | None:
    known = [each for each in forces if each is not None]
    if not known:
        return None
    return CouplerForces(
        max(each.largest_pull_n for each in known), max(each.largest_push_n for each in known)
    )
