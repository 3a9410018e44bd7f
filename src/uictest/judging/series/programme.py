"""The verdict on each test of a programme: whether its stops are valid tests and keep their limit."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import fmean
from typing import Literal

from uictest.judging.evaluation import CaseResult, why_no_test
from uictest.plans.series import PlannedTest, Programme

TestStatus = Literal[
    "met", "missed", "some met", "no valid test", "no standstill", "no reference", "no limit", "not run"
]
"""some met: not all stops do, and whether each must or their mean is not known. no reference: the test that
the limit is a share of was not run, or came to no standstill."""


@dataclass(frozen=True, slots=True)
class Limits:
    """Between which distances in m a test must stop, both excluded, and its largest one.

    The largest is NaN where the reference has no distance.
    """

    above: float = -math.inf
    below: float = math.inf
    largest: float = math.inf

    def hold(self, distance: float) -> bool:
        """Return whether a distance keeps them; never where one is not known."""
        return self.above < distance < self.below and distance <= self.largest


@dataclass(frozen=True, slots=True)
class JudgedTest:
    """A test of a programme with its stops as they were run.

    Args:
        planned: the test.
        stops: its results, those that were run.
        limits: of the distance; None where it has none.

    """

    planned: PlannedTest
    stops: tuple[CaseResult, ...]
    limits: Limits | None

    @property
    def distances(self) -> list[float]:
        """Braking distances of the stops, m; NaN where a stop came to none."""
        return [braking_distance(stop) for stop in self.stops]

    @property
    def mean(self) -> float:
        """Mean braking distance, m."""
        return fmean(self.distances) if self.stops else math.nan

    @property
    def within(self) -> int:
        """Number of stops within the limits."""
        limits = self.limits
        return 0 if limits is None else sum(limits.hold(distance) for distance in self.distances)

    @property
    def valid_stops(self) -> int:
        """Number of stops shown to be tests as measured, or to which no criterion of validity applies."""
        return sum(stop.outcome != "error" and not why_no_test(stop.criteria) for stop in self.stops)

    @property
    def missed_requirements(self) -> list[str]:
        """Ids of the requirements of its scenario that a stop misses: the programme knows none of them."""
        verdicts = (verdict for stop in self.stops for verdict in stop.criteria)
        missed = (each.id for each in verdicts if each.status == "fail" and each.layer == "requirement")
        return list(dict.fromkeys(missed))

    @property
    def status(self) -> TestStatus:
        """The verdict, on the stops as measured."""
        limits = self.limits
        if len(self.stops) < len(self.planned.stops) or any(stop.outcome == "error" for stop in self.stops):
            return "not run"
        if limits is not None and not math.isfinite(self.mean):
            return "no standstill"
        if limits is not None and math.isnan(limits.largest):
            return "no reference"
        if self.valid_stops < len(self.stops):
            return "no valid test"
        if limits is None:
            return "no limit"
        if self.within == len(self.stops):  # so is their mean
            return "met"
        return "missed" if self.within == 0 and not limits.hold(self.mean) else "some met"


def braking_distance(result: CaseResult) -> float:
    """Return the braking distance of a stop, m; NaN where it came to none."""
    return math.nan if result.measures is None else float(result.measures["braking_distance_m"])


def judge_programme(programme: Programme, results: Sequence[CaseResult]) -> list[JudgedTest]:
    """Return the verdict on each test of which stops were run, from the results of all in any order."""
    by_id = {result.id: result for result in results}
    stops = {
        planned.test.name: tuple(by_id[case.id] for case in planned.stops if case.id in by_id)
        for planned in programme.tests
    }
    whole = {
        each.test.name: own
        for each in programme.tests
        if len(own := stops[each.test.name]) == len(each.stops)
    }
    return [
        JudgedTest(planned, stops[planned.test.name], _limits(planned, whole))
        for planned in programme.tests
        if stops[planned.test.name]
    ]


def _limits(planned: PlannedTest, whole: Mapping[str, Sequence[CaseResult]]) -> Limits | None:
    """Return the limits of a test; those of a share need every stop of its reference."""
    limit = planned.test.distance
    if limit is None:
        return None
    if limit.at_most is not None and limit.of is not None:
        reference = [braking_distance(stop) for stop in whole.get(limit.of, ())]
        return Limits(largest=float(limit.at_most) * fmean(reference) if reference else math.nan)
    above = -math.inf if limit.above is None else float(limit.above)
    return Limits(above, math.inf if limit.below is None else float(limit.below))
