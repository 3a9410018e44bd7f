"""The outcomes and verdicts of stops with other values of numbers, and which of them are another."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Final

from uictest.judging.evaluation import Verdict, by_reading, relative_margin, why_no_test

OUTCOME: Final = ""
"""In place of the id of a criterion: the outcome."""
_DECIDING: Final = {"invalid": "fail", "skipped": "not_applicable"}
"""Status of the criteria that decide an outcome, where it has another name."""
Place = tuple[int, int]
"""A number, by its place in the list, and an end of its range: lowest 0, highest 1."""


@dataclass(frozen=True, slots=True)
class Drawn:
    """The outcome of one stop, or one series, with some values of the numbers, and its verdicts by criterion.

    Args:
        outcome: of the stop or series.
        statuses: of its criteria, then of their other readings, by id.
        margins: shares of the limits, of those that have one.
        readings: the readings, which decide nothing: id -> that of the criterion.
        is_test: whether nothing keeps it from counting as a test.

    """

    outcome: str
    statuses: Mapping[str, str] = field(default_factory=dict)
    margins: Mapping[str, float] = field(default_factory=dict)
    readings: Mapping[str, str] = field(default_factory=dict)
    is_test: bool = True

    def status(self, criterion: str) -> str:
        """Return the status of a criterion, or the outcome."""
        return self.outcome if criterion == OUTCOME else self.statuses.get(criterion, "error")


def drawn(outcome: str, verdicts: Sequence[Verdict]) -> Drawn:
    """Return an outcome and verdicts, without those of checks."""
    judged = [verdict for verdict in verdicts if not verdict.is_check]
    read = [
        (by_reading(each, other), each.id) for each in judged for other in each.readings if not other.decides
    ]
    every = [*judged, *(reading for reading, _ in read)]
    margins = {each.id: share for each in every if (share := relative_margin(each)) is not None}
    statuses = {each.id: each.status for each in every}
    of_readings = {reading.id: criterion for reading, criterion in read}
    return Drawn(outcome, statuses, margins, of_readings, not why_no_test(verdicts))


@dataclass(frozen=True)
class Stops:
    """The verdicts of all stops.

    Args:
        nominal: under each seed, all numbers being nominal.
        ends: with one number at an end of its range, under some seeds.
        joint: of the draws of all numbers together.
        calibrated: of each draw whether the stops by which the numbers are known still hold; None: not asked.
        validity: ids of the criteria that say whether a stop is a test.

    """

    nominal: Sequence[Drawn]
    ends: Mapping[Place, Sequence[Drawn]]
    joint: Sequence[Drawn]
    calibrated: Sequence[bool] | None
    validity: frozenset[str]

    @property
    def not_run(self) -> list[Place]:
        """The ends at which no stop could be run."""
        return [place for place, drawn in self.ends.items() if all(each.outcome == "error" for each in drawn)]

    @cached_property
    def _usual(self) -> dict[str, str]:
        return {}

    def usual(self, criterion: str) -> str:
        """Return what a verdict is at the nominal values, under most seeds."""
        if criterion not in self._usual:
            self._usual[criterion] = usual(self.nominal, criterion)
        return self._usual[criterion]

    def stands(self, drawn: Drawn, criterion: str) -> bool | None:
        """Return whether a verdict is what it is at the nominal values; None for one that does not count.

        What is required of a test does not count where there is none.
        """
        own = self.nominal[0].readings.get(criterion, criterion)
        of_validity = own in self.validity or (criterion == OUTCOME and not self._is_nominally_a_test)
        if drawn.outcome == "error" or (not drawn.is_test and not of_validity):
            return None
        return drawn.status(criterion) == self.usual(criterion)

    @cached_property
    def _is_nominally_a_test(self) -> bool:
        """Whether most of the nominal stops were valid tests."""
        return 2 * sum(each.is_test for each in self.nominal) > len(self.nominal)

    def turned_at(self, place: Place, criterion: str) -> list[Drawn]:
        """Return the stops at an end in which a verdict is another."""
        return [each for each in self.ends[place] if self.stands(each, criterion) is False]

    def deciding_at(self, place: Place) -> str:
        """Return the first criterion that decides the outcome at an end where it is another; empty for none.

        To pass, it is the first of those that decided the nominal outcome.
        """
        turned, nominal = self.turned_at(place, OUTCOME)[0], self.nominal[0]
        one, other = (nominal, turned) if turned.outcome == "pass" else (turned, nominal)
        status = _DECIDING.get(one.outcome, one.outcome)
        criteria = (each for each in one.statuses if each not in one.readings)
        decides = (each for each in criteria if one.status(each) == status != other.status(each))
        return next(decides, OUTCOME)


def usual(drawn: Sequence[Drawn], criterion: str) -> str:
    """Return the most frequent status; of equally frequent ones the first."""
    return Counter(each.status(criterion) for each in drawn).most_common(1)[0][0]


def share(stands: Sequence[bool | None]) -> float | None:
    """Return the share of stops in which a verdict stands, of those that count; None without any."""
    counted = [each for each in stands if each is not None]
    return sum(counted) / len(counted) if counted else None
