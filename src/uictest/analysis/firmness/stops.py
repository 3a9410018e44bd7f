"""Stops with other values of numbers: which verdicts are another, and where one turns."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from typing import Final

import numpy as np

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
        outcome: outcome of the stop or series.
        statuses: statuses of its criteria, then of their other readings, by id.
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
    _usual: dict[str, str] = field(default_factory=dict)

    @property
    def not_run(self) -> list[Place]:
        """The ends at which no stop could be run."""
        return [place for place, drawn in self.ends.items() if all(each.outcome == "error" for each in drawn)]

    def usual(self, criterion: str) -> str:
        """Return the status of a criterion at the nominal values, under most seeds."""
        if criterion not in self._usual:
            self._usual[criterion] = usual(self.nominal, criterion)
        return self._usual[criterion]

    def stands(self, drawn: Drawn, criterion: str) -> bool | None:
        """Return whether a verdict is the same as at the nominal values; None for one that does not count.

        What is required of a test does not count where there is none.
        """
        read_criterion = self.nominal[0].readings.get(criterion, criterion)
        of_no_test = criterion == OUTCOME and not self._is_nominally_a_test
        of_validity = read_criterion in self.validity or of_no_test
        if drawn.outcome == "error" or (not drawn.is_test and not of_validity):
            return None
        return drawn.status(criterion) == self.usual(criterion)

    @cached_property
    def _is_nominally_a_test(self) -> bool:
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


_POINTS: Final = 8
"""Places of a first scan; chosen."""
_HALVINGS: Final = 4
"""Of the interval between two places of a scan: a turning value is known to 1 / 128 of its side; chosen."""
Setting = tuple[int | None, float]
"""A number, by its place in the list, moved to a place of its range; None: all numbers are nominal."""
Run = Callable[[Sequence[tuple[Setting, int]]], Sequence[Drawn]]
"""Runs stops, each with a setting and a seed."""


@dataclass(frozen=True)
class MovedStops:
    """Stops in which one number is moved and all others are nominal; each of them is run once.

    Args:
        run: runs further stops.
        known: those that were run.

    """

    run: Run
    known: dict[tuple[Setting, int], Drawn]

    def at(self, settings: Iterable[Setting], seeds: int) -> dict[Setting, list[Drawn]]:
        """Return the stops of settings under the first seeds."""
        stops = {setting: [(setting, seed) for seed in range(seeds)] for setting in settings}
        missing = [each for of_setting in stops.values() for each in of_setting if each not in self.known]
        if missing:
            self.known.update(zip(missing, self.run(missing), strict=True))
        return {setting: [self.known[each] for each in of_setting] for setting, of_setting in stops.items()}


@dataclass(frozen=True, slots=True)
class Scan:
    """The share of seeds under which a verdict stands, at places from the nominal value to an end."""

    standing: dict[float, float]
    end: float

    def grid(self) -> list[float]:
        """Return evenly spaced places up to the end, without the nominal one."""
        start = next(iter(self.standing))
        points: list[float] = np.linspace(start, self.end, _POINTS + 1)[1:].tolist()
        return points

    @property
    def ends_turned(self) -> bool:
        """Whether most seeds turn at the end: else no single change lies before it."""
        return self.end in self.standing and self.standing[self.end] <= 0.5

    @property
    def _from_nominal(self) -> list[float]:
        return sorted(self.standing, reverse=self.end == 0.0)

    @property
    def _single_change(self) -> tuple[float, float] | None:
        """The neighbouring places between which most seeds turn; None without a single such change."""
        changes = [
            (before, after)
            for before, after in pairwise(self._from_nominal)
            if (self.standing[before] > 0.5) != (self.standing[after] > 0.5)
        ]
        return changes[0] if len(changes) == 1 else None

    @property
    def middle(self) -> float | None:
        """The middle of that change."""
        return None if self._single_change is None else 0.5 * sum(self._single_change)

    @property
    def turning_value(self) -> float | None:
        """The first place at which the verdict is turned under most seeds; None without a single change."""
        return None if self._single_change is None else self._single_change[1]

    @property
    def values(self) -> tuple[float | None, float, float | None]:
        """The turning value; the last place at which all seeds stand; the first from which on none does."""
        places = self._from_nominal
        unsettled = next((k for k, each in enumerate(places) if self.standing[each] < 1.0), len(places))
        standing = max((k for k, each in enumerate(places) if self.standing[each] > 0.0), default=-1)
        none_stands = places[standing + 1] if standing + 1 < len(places) else None
        return self.turning_value, places[max(unsettled - 1, 0)], none_stands


def scan_side_by_side(
    turning: Mapping[str, Sequence[Place]],
    nominal_places: Sequence[float],
    stops: Stops,
    moved: MovedStops,
    seeds: int,
) -> dict[tuple[str, Place], Scan]:
    """Scan numbers from their nominal values to an end, then halve: all verdicts together.

    Where the end does not turn most seeds there is no turning value, and nothing is scanned.

    Args:
        turning: the ends at which each verdict turns under some seed.
        nominal_places: nominal places of the numbers, in their ranges.
        stops: say what a verdict is at the nominal values.
        moved: runs the stops.
        seeds: under which each place is run.

    """
    scans = {
        (criterion, place): Scan({nominal_places[place[0]]: 1.0}, float(place[1]))
        for criterion, places in turning.items()
        for place in places
    }

    def extend(points: Mapping[tuple[str, Place], Sequence[float]]) -> None:
        settings = {key: [(key[1][0], point) for point in of_key] for key, of_key in points.items()}
        drawn = moved.at(dict.fromkeys(each for of_key in settings.values() for each in of_key), seeds)
        for key, of_key in settings.items():
            for setting in of_key:
                standing = share([stops.stands(each, key[0]) for each in drawn[setting]])
                if standing is not None:
                    scans[key].standing[setting[1]] = standing

    extend({key: [scan.end] for key, scan in scans.items()})
    searched = {key: scan for key, scan in scans.items() if scan.ends_turned}
    extend({key: scan.grid() for key, scan in searched.items()})
    for _ in range(_HALVINGS):
        middles = {key: scan.middle for key, scan in searched.items()}
        extend({key: [middle] for key, middle in middles.items() if middle is not None})
    return scans
