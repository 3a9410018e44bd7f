"""Whether verdicts hang on numbers with a plausible range: at its ends, in draws of all, where they turn."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from statistics import median
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.analysis.firmness.stops import (
    OUTCOME,
    Drawn,
    MovedStops,
    Place,
    Scan,
    Setting,
    Stops,
    scan_side_by_side,
    share,
    usual,
)
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


@dataclass(frozen=True, slots=True)
class Effort:
    """How many stops are run; the numbers are chosen: enough draws for :data:`FIRM_SHARE`, if most count.

    Args:
        blocks: blocks of draws of all numbers together, each scrambled for itself.
        block: draws of a block, a power of two.
        seeds: under which the nominal stop, and those of a search for a turning value, are run.
        seeds_at_ends: under which a stop with one number at an end of its range is run.

    """

    blocks: int = 8
    block: int = 128
    seeds: int = 16
    seeds_at_ends: int = 4

    def stops(self, numbers: int) -> int:
        """Return the number of stops that are run before any turning value is searched."""
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
        expect: is called with how many stops a search for turning values will run, before it runs them.
    """

    numbers: Sequence[RangedNumber]
    judge: JudgeDraws
    hold: HoldDraws | None = None
    validity: frozenset[str] = frozenset()
    effort: Effort = field(default_factory=Effort)
    random_rail: bool = False
    expect: Callable[[int], None] = lambda count: None

    def run(
        self,
        *,
        on_four_calipers: bool = False,
        in_survey_steps: bool = False,
        calibrated_by: Sequence[str] = (),
        without_range: Iterable[str] = (),
    ) -> Firmness:
        """Run all stops and return what they show. Arguments as for :class:`Firmness`."""
        count, effort = len(self.numbers), self.effort
        places = [(number, end) for number in range(count) for end in (0, 1)]
        nominal: list[tuple[Setting, int]] = [((None, math.nan), seed) for seed in range(effort.seeds)]
        at_ends: list[tuple[Setting, int]] = [
            ((number, float(end)), seed) for number, end in places for seed in range(effort.seeds_at_ends)
        ]
        drawn = self._run_moved([*nominal, *at_ends])
        moved = MovedStops(self._run_more, dict(zip(at_ends, drawn[len(nominal) :], strict=True)))
        of_ends = moved.at([(number, float(end)) for number, end in places], effort.seeds_at_ends)
        points = sobol_blocks(effort.blocks, effort.block, count, seed=0) if count else np.empty((0, 0))
        stops = Stops(
            drawn[: len(nominal)],
            {(number, end): of_ends[number, float(end)] for number, end in places},
            self._run_at_places(points, range(len(points)) if self.random_rail else [0] * len(points)),
            None if self.hold is None or not len(points) else self.hold(self._number_columns(points)),
            self.validity,
        )
        criteria = [each for each in stops.nominal[0].statuses if stops.usual(each) in _DECIDED]
        # A verdict that turns over the seeds, too, turns at no end.
        turning = {
            each: [place for place in stops.ends if stops.turned_at(place, each)]
            if not self._turns_by_noise(each, stops)
            else []
            for each in (OUTCOME, *criteria)
        }
        nominal_places = [each.nominal_place for each in self.numbers]
        scans = scan_side_by_side(turning, nominal_places, stops, moved, effort.seeds)
        turns = {
            each: tuple(self._turn_of_number(each, place, scans[each, place], stops) for place in of_verdict)
            for each, of_verdict in turning.items()
        }
        outcomes = Counter(each.outcome for each in stops.joint)
        return Firmness(
            **self._firmness(OUTCOME, stops, turns[OUTCOME]),
            criteria=tuple(VerdictFirmness(**self._firmness(each, stops, turns[each])) for each in criteria),
            numbers=tuple(self._number_effect(number, stops, criteria) for number in range(count)),
            draws=len(stops.joint),
            infeasible=outcomes["error"],
            outcomes=dict(outcomes),
            not_run=tuple(dict.fromkeys(self.numbers[number].key for number, _ in stops.not_run)),
            seeds=effort.seeds,
            on_four_calipers=on_four_calipers,
            in_survey_steps=in_survey_steps,
            calibrated_by=tuple(calibrated_by),
            without_range=tuple(dict.fromkeys(without_range)),
        )

    def _run_at_places(self, places: NDArray[np.float64], seeds: Iterable[int]) -> Sequence[Drawn]:
        """Run stops whose numbers lie at places of their ranges, NaN for the nominal value."""
        if not len(places):
            return ()
        return self.judge(self._number_columns(places), [*seeds])

    def _number_columns(self, places: NDArray[np.float64]) -> list[Column]:
        return [each.at(places[:, k]) for k, each in enumerate(self.numbers)]

    def _run_moved(self, stops: Sequence[tuple[Setting, int]]) -> Sequence[Drawn]:
        places = np.full((len(stops), len(self.numbers)), np.nan)
        for row, ((number, place), _) in enumerate(stops):
            if number is not None:
                places[row, number] = place
        return self._run_at_places(places, [seed for _, seed in stops])

    def _run_more(self, stops: Sequence[tuple[Setting, int]]) -> Sequence[Drawn]:
        self.expect(len(stops))
        return self._run_moved(stops)

    def _turns_by_noise(self, criterion: str, stops: Stops) -> bool:
        nominal = stops.usual(criterion)
        return any(each.outcome != "error" and each.status(criterion) != nominal for each in stops.nominal)

    def _firmness(self, criterion: str, stops: Stops, turns: tuple[Turn, ...]) -> dict[str, Any]:
        """Return the fields of :class:`VerdictFirmness` for a criterion, or the outcome."""
        joint = [stops.stands(each, criterion) for each in stops.joint]
        size = self.effort.block
        shares = [share(joint[first : first + size]) for first in range(0, len(joint), size)]
        counted_shares = [each for each in shares if each is not None]
        counted, turned = len(joint) - joint.count(None), joint.count(False)
        # An end that cannot be run shows nothing, whatever the draws say.
        no_turn_seen = counted and not turned and not stops.not_run
        at_least = _DOUBT ** (1.0 / counted) if no_turn_seen else None
        calibrated = None
        if stops.calibrated is not None:
            pairs = zip(joint, stops.calibrated, strict=True)
            holding = [stands for stands, holds in pairs if holds and stands is not None]
            calibrated = CalibratedDraws(len(holding), share(holding))
        return {
            "criterion": criterion,
            "nominal": stops.usual(criterion),
            "status": _firmness_status(
                self._turns_by_noise(criterion, stops), bool(turns or turned), at_least
            ),
            "counted": counted,
            "turned": turned,
            "share": share(joint),
            "share_at_least": at_least,
            "lowest_block": min(counted_shares, default=None),
            "highest_block": max(counted_shares, default=None),
            "calibrated": calibrated,
            "margin": _known_median(each.margins.get(criterion) for each in stops.nominal),
            "turned_by": turns,
        }

    def _turn_of_number(self, criterion: str, place: Place, scan: Scan, stops: Stops) -> Turn:
        """Return the value at which a number turns a verdict, with the criterion that turns the outcome."""
        ranged, end = self.numbers[place[0]], place[1]
        turns_at, stands_to, turned_from = scan.values
        # Rounded to where it was seen: what stands towards the nominal value, what is turned to the end.
        value, first_turned = (
            "" if each is None else ranged.rounded_text(each, up=bool(end))
            for each in (turns_at, turned_from)
        )
        return Turn(
            *(ranged.key, "above" if end else "below", criterion or stops.deciding_at(place)),
            usual(stops.turned_at(place, criterion), criterion),
            *(value, ranged.rounded_text(stands_to, up=not end), first_turned, ranged.ends[end].text),
        )

    def _number_effect(self, number: int, stops: Stops, criteria: Sequence[str]) -> NumberEffect:
        ranged = self.numbers[number]
        margins = {
            each: (
                _known_median(drawn.margins.get(each) for drawn in stops.ends[number, 0]),
                _known_median(drawn.margins.get(each) for drawn in stops.ends[number, 1]),
            )
            for each in criteria
        }
        low, high = (end.text for end in ranged.ends)
        about = ranged.key, ranged.value.text, low, high, ranged.mark, ranged.reason
        return NumberEffect(*about, margins, ranged.value.prior)


def _firmness_status(noisy: bool, turns: bool, at_least: float | None) -> FirmnessStatus:
    if noisy:
        return "noise"
    if turns:
        return "turns"
    return "firm" if at_least is not None and at_least >= FIRM_SHARE else "not_shown"


def _known_median(values: Iterable[float | None]) -> float | None:
    return median(known) if (known := [each for each in values if each is not None]) else None
