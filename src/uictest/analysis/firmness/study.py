"""Whether verdicts hang on numbers with a plausible range: at its ends, in draws of all, where they turn."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from statistics import median
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.analysis.firmness.scan import Scan
from uictest.analysis.firmness.stops import OUTCOME, Drawn, Place, Stops, usual
from uictest.judging.evaluation import (
    CalibratedDraws,
    Firmness,
    FirmnessStatus,
    NumberEffect,
    Turn,
    VerdictFirmness,
)
from uictest.plans.sweeps import Column, RangedNumber, sobol_blocks

_DECIDED: Final = ("pass", "fail")
"""Statuses whose firmness is studied: all others are no verdict on the stop."""
FIRM_SHARE: Final = 0.997
"""Share of draws, with 95 % confidence, in which a firm verdict stands at least; chosen: what 1 000
draws without a turn show."""
_DOUBT: Final = 0.05
"""Probability that a share lies below its bound: 95 % confidence, as usual of test results; chosen."""
_HALVINGS: Final = 4
"""Of the interval between two places of a scan: a turning value is known to 1 / 128 of its side; chosen."""


@dataclass(frozen=True, slots=True)
class Effort:
    """How many stops are run; the numbers are chosen: enough draws for :data:`FIRM_SHARE`, if most count.

    Args:
        blocks: of draws of all numbers together, each scrambled for itself.
        block: draws of a block, a power of two.
        seeds: under which the nominal stop, and those of a search for a turning value, are run.
        seeds_at_ends: under which a stop with one number at an end of its range is run.

    """

    blocks: int = 8
    block: int = 128
    seeds: int = 16
    seeds_at_ends: int = 4

    def stops(self, numbers: int) -> int:
        """Return how many stops are run before any turning value is searched."""
        return self.seeds + 2 * numbers * self.seeds_at_ends + self.draws

    @property
    def draws(self) -> int:
        """The number of draws of all numbers together."""
        return self.blocks * self.block


JudgeDraws = Callable[[Sequence[Column], Sequence[int]], Sequence[Drawn]]
"""Runs stops: for each number its values in all stops; for each stop its seed, from 0 for the nominal one."""
HoldDraws = Callable[[Sequence[Column]], Sequence[bool]]
"""Says of each draw whether the stops by which the numbers are known still come to what they came to."""


@dataclass(frozen=True)
class FirmnessStudy:
    """Finds out how firm the verdicts of a case or a series are.

    Args:
        numbers: with a range.
        judge: runs stops.
        hold: whether a draw keeps to what is known of the numbers; None where that is not asked.
        validity: ids of the criteria that say whether a stop is a test.
        effort: how many stops.
        random_rail: whether friction varies at random, so that every draw has a seed of its own.
    """

    numbers: Sequence[RangedNumber]
    judge: JudgeDraws
    hold: HoldDraws | None = None
    validity: frozenset[str] = frozenset()
    effort: Effort = field(default_factory=Effort)
    random_rail: bool = False

    def run(self, *, on_four_calipers: bool = False, calibrated_by: Sequence[str] = ()) -> Firmness:
        """Run all stops and return what they show. Arguments as for :class:`Firmness`."""
        count, effort = len(self.numbers), self.effort
        places = [(number, end) for number in range(count) for end in (0, 1)]
        at_ends = self._one_by_one([(number, float(end)) for number, end in places], effort.seeds_at_ends)
        points = sobol_blocks(effort.blocks, effort.block, count, seed=0) if count else np.empty((0, 0))
        stops = Stops(
            self._drawn(np.full((effort.seeds, count), np.nan), range(effort.seeds)),
            dict(zip(places, at_ends, strict=True)),
            self._drawn(points, range(len(points)) if self.random_rail else [0] * len(points)),
            None if self.hold is None or not len(points) else self.hold(self._columns(points)),
            self.validity,
        )
        criteria = [each for each in stops.nominal[0].statuses if stops.usual(each) in _DECIDED]
        outcomes = Counter(each.outcome for each in stops.joint)
        return Firmness(
            **self._firmness(OUTCOME, stops),
            criteria=tuple(VerdictFirmness(**self._firmness(each, stops)) for each in criteria),
            numbers=tuple(self._effect(number, stops, criteria) for number in range(count)),
            draws=len(stops.joint),
            infeasible=outcomes["error"],
            outcomes=dict(outcomes),
            not_run=tuple(dict.fromkeys(self.numbers[number].key for number, _ in stops.not_run)),
            seeds=effort.seeds,
            on_four_calipers=on_four_calipers,
            calibrated_by=tuple(calibrated_by),
        )

    def _drawn(self, places: NDArray[np.float64], seeds: Iterable[int]) -> Sequence[Drawn]:
        """Run stops whose numbers lie at places of their ranges, NaN for the nominal value."""
        if not len(places):
            return ()
        return self.judge(self._columns(places), [*seeds])

    def _columns(self, places: NDArray[np.float64]) -> list[Column]:
        return [each.at(places[:, k]) for k, each in enumerate(self.numbers)]

    def _one_by_one(self, settings: Sequence[tuple[int, float]], seeds: int) -> list[Sequence[Drawn]]:
        """Return for each number and place of it the stops in which all others are nominal, one per seed."""
        places = np.full((len(settings) * seeds, len(self.numbers)), np.nan)
        for row, (number, place) in enumerate(settings):
            places[row * seeds : (row + 1) * seeds, number] = place
        stops = self._drawn(places, [*range(seeds)] * len(settings))
        return [stops[first : first + seeds] for first in range(0, len(stops), seeds)]

    def _firmness(self, criterion: str, stops: Stops) -> dict[str, Any]:
        """Return the fields of :class:`VerdictFirmness` for a criterion, or the outcome."""
        nominal = stops.usual(criterion)
        joint = [stops.stands(each, criterion) for each in stops.joint]
        size = self.effort.block
        shares = [_share(joint[first : first + size]) for first in range(0, len(joint), size)]
        known = [share for share in shares if share is not None]
        counted, turned = len(joint) - joint.count(None), joint.count(False)
        noisy = any(each.outcome != "error" and each.status(criterion) != nominal for each in stops.nominal)
        turning = [place for place in stops.ends if stops.turned_at(place, criterion)]
        # An end that cannot be run shows nothing, whatever the draws say.
        shown = counted and not turned and not stops.not_run
        at_least = _DOUBT ** (1.0 / counted) if shown else None
        return {
            "criterion": criterion,
            "nominal": nominal,
            "status": _status(noisy, bool(turning or turned), at_least),
            "counted": counted,
            "turned": turned,
            "share": _share(joint),
            "share_at_least": at_least,
            "lowest_block": min(known, default=None),
            "highest_block": max(known, default=None),
            "calibrated": None if stops.calibrated is None else _calibrated(joint, stops.calibrated),
            "margin": _median(each.margins.get(criterion) for each in stops.nominal),
            "turned_by": () if noisy else tuple(self._turns(criterion, turning, stops)),
        }

    def _turns(self, criterion: str, turning: Sequence[Place], stops: Stops) -> Iterator[Turn]:
        """Yield where each number turns a verdict, and the criterion with which the outcome turns."""
        scans = self._scanned(turning, criterion, stops)
        for place in turning:
            ranged, end = self.numbers[place[0]], place[1]
            scan = scans[place]
            turns_at, stands_to, turned_from = scan.values
            # Rounded to where it was seen: what stands towards the nominal value, what is turned to the end.
            value, first_turned = (
                "" if each is None else ranged.rounded_text(each, up=bool(end))
                for each in (turns_at, turned_from)
            )
            yield Turn(
                *(ranged.key, "above" if end else "below", criterion or stops.deciding_at(place)),
                usual(stops.turned_at(place, criterion), criterion),
                *(value, ranged.rounded_text(stands_to, up=not end), first_turned, ranged.ends[end].text),
            )

    def _scanned(self, turning: Sequence[Place], criterion: str, stops: Stops) -> dict[Place, Scan]:
        """Scan each number from its nominal value to an end, all numbers together, then halve."""
        scans = {
            (number, end): Scan({self.numbers[number].nominal_place: 1.0}, float(end))
            for number, end in turning
        }
        self._extend(scans, {place: scan.grid() for place, scan in scans.items()}, criterion, stops)
        for _ in range(_HALVINGS):
            middles = {place: [scan.middle] for place, scan in scans.items() if scan.middle is not None}
            self._extend(scans, middles, criterion, stops)
        return scans

    def _extend(
        self,
        scans: Mapping[Place, Scan],
        points: Mapping[Place, Sequence[float]],
        criterion: str,
        stops: Stops,
    ) -> None:
        flat = [(place, point) for place, of_place in points.items() for point in of_place]
        drawn = self._one_by_one([(place[0], point) for place, point in flat], self.effort.seeds)
        for (place, point), of_point in zip(flat, drawn, strict=True):
            standing = _share([stops.stands(each, criterion) for each in of_point])
            if standing is not None:
                scans[place].standing[point] = standing

    def _effect(self, number: int, stops: Stops, criteria: Sequence[str]) -> NumberEffect:
        ranged = self.numbers[number]
        margins = {
            each: (
                _median(drawn.margins.get(each) for drawn in stops.ends[number, 0]),
                _median(drawn.margins.get(each) for drawn in stops.ends[number, 1]),
            )
            for each in criteria
        }
        low, high = (end.text for end in ranged.ends)
        return NumberEffect(ranged.key, ranged.value.text, low, high, ranged.mark, ranged.reason, margins)


def _status(noisy: bool, turns: bool, at_least: float | None) -> FirmnessStatus:
    if noisy:
        return "noise"
    if turns:
        return "turns"
    return "firm" if at_least is not None and at_least >= FIRM_SHARE else "not_shown"


def _share(stands: Sequence[bool | None]) -> float | None:
    counted = [each for each in stands if each is not None]
    return sum(counted) / len(counted) if counted else None


def _calibrated(stands: Sequence[bool | None], holds: Sequence[bool]) -> CalibratedDraws:
    counted = [each for each, known in zip(stands, holds, strict=True) if known and each is not None]
    return CalibratedDraws(len(counted), _share(counted))


def _median(values: Iterable[float | None]) -> float | None:
    return median(known) if (known := [each for each in values if each is not None]) else None
