"""Where a verdict turns between the nominal value of a number and an end of its range."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np

from uictest.analysis.firmness.stops import Drawn, Place, Stops, share

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
    def _change(self) -> tuple[float, float] | None:
        """The neighbouring places between which most seeds turn; None without a single such change."""
        changes = [
            (one, other)
            for one, other in pairwise(self._from_nominal)
            if (self.standing[one] > 0.5) != (self.standing[other] > 0.5)
        ]
        return changes[0] if len(changes) == 1 else None

    @property
    def middle(self) -> float | None:
        """The middle of that change."""
        return None if self._change is None else 0.5 * sum(self._change)

    @property
    def turning_value(self) -> float | None:
        """The first place at which the verdict is turned under most seeds; None without a single change."""
        return None if self._change is None else self._change[1]

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
        nominal_places: of the numbers, in their ranges.
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
