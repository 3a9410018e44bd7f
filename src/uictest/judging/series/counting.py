"""The stops of a series that count, and criteria that refer to its dry stop."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from uictest.core.measures import MEASURES
from uictest.core.series_measures import CountedStop, Rail, SpeedStops, of_stop
from uictest.core.units import KILOMETRE_PER_HOUR, in_unit
from uictest.judging import evaluation
from uictest.judging.evaluation import CaseResult, Outcome, RepeatedStop, Verdict
from uictest.judging.series.result import SeriesCase, StopCounts, UncountedStop
from uictest.plans import scenario as scenarios
from uictest.plans.scenario import Criterion
from uictest.plans.series import Role, Series


@dataclass(frozen=True, slots=True)
class SeriesStop:
    """One stop of a case: itself, or one of its repeats.

    `not_counted` says why it does not count as a test: it failed to run, it could not be judged, it is none;
    None where it counts, whatever requirements it misses.
    """

    role: Role
    speed_kmh: float
    rail: Rail
    case: str
    seed: int | None
    outcome: Outcome
    reason: str
    not_counted: Outcome | None
    criteria: tuple[Verdict, ...]
    figures: CountedStop

    @property
    def counts(self) -> bool:
        """Whether the stop counts as a test: it was judged, and its criteria of validity hold."""
        return self.not_counted is None

    def verdict(self, criterion: str) -> Verdict | None:
        """Return its verdict on a criterion, None where it has none."""
        return next((each for each in self.criteria if each.id == criterion), None)


def observed_stops(cases: Sequence[SeriesCase], speed_tolerance_kmh: float) -> list[SeriesStop]:
    """Return all stops of cases, repeats one by one.

    A stop whose initial speed is farther from the nominal one than the tolerance (km/h) is invalid.
    """
    return [stop for each in cases for stop in _stops_of_case(each, speed_tolerance_kmh)]


def _stops_of_case(series_case: SeriesCase, speed_tolerance_kmh: float) -> Iterator[SeriesStop]:
    case = series_case.case
    # A stop that is not repeated is the case itself, without a seed.
    stops: list[tuple[int | None, CaseResult | RepeatedStop]] = [(None, case)]
    if case.repeats is not None:
        stops = [(stop.seed, stop) for stop in case.repeats.stops]
    for seed, stop in stops:
        uncounted_as, reason = _why_not_counted(stop)
        if uncounted_as is None:
            reason = _speed_mismatch_reason(stop.measures or {}, series_case.speed_kmh, speed_tolerance_kmh)
            uncounted_as = "invalid" if reason else None
        yield SeriesStop(
            role=series_case.role,
            speed_kmh=series_case.speed_kmh,
            rail=series_case.rail,
            case=case.id,
            seed=seed,
            outcome=stop.outcome,
            reason=reason,
            not_counted=uncounted_as,
            criteria=stop.criteria,
            figures=CountedStop(
                dict(stop.measures or {}),
                tuple(stop.wheelsets),
                passed=None if stop.outcome == "inconclusive" else stop.outcome == "pass",
            ),
        )


def _why_not_counted(stop: CaseResult | RepeatedStop) -> tuple[Outcome | None, str]:
    """Return the outcome that keeps a stop from counting, and the reason; None where it counts.

    Validity is asked, whatever requirements it misses or leaves open, and that it was observed to its end.
    """
    if stop.outcome in ("error", "skipped"):
        return stop.outcome, stop.reason
    if no_test := evaluation.why_no_test(stop.decided):
        failed = any(each.status == "fail" for each in no_test)
        return "invalid" if failed else "inconclusive", evaluation.reasons_of(no_test)
    if stop.outcome == "inconclusive" and math.isnan(
        (stop.measures or {}).get("braking_distance_m", math.nan)
    ):
        return "inconclusive", stop.reason
    return None, ""


def _speed_mismatch_reason(measures: Mapping[str, float], nominal_kmh: float, tolerance_kmh: float) -> str:
    """Return the reason if the initial speed is off the nominal one; empty if it is not, or is unknown."""
    distance = measures.get("braking_distance_m", math.nan)
    deceleration = measures.get("mean_deceleration_mps2", math.nan)
    # The mean deceleration is v0^2 / (2 s).
    initial_kmh = in_unit(math.sqrt(max(2.0 * deceleration * distance, 0.0)), "km/h")
    if not abs(initial_kmh - nominal_kmh) > tolerance_kmh * (1.0 + 1e-9) + 1e-6:
        return ""
    return f"initial speed is {initial_kmh:.4g} km/h, nominal {nominal_kmh:g} +- {tolerance_kmh:g} km/h"


def counts_of(stops: Sequence[SeriesStop]) -> StopCounts:
    """Return the number of stops, and of those that count."""
    return StopCounts(len(stops), sum(stop.counts for stop in stops))


def not_counted(stops: Sequence[SeriesStop]) -> tuple[UncountedStop, ...]:
    """Return the stops that do not count, with the reason of each."""
    return tuple(
        UncountedStop(stop.case, stop.role, stop.seed, stop.not_counted, stop.reason)
        for stop in stops
        if stop.not_counted is not None
    )


def with_relations(series: Series, stops: Sequence[SeriesStop]) -> list[SeriesStop]:
    """Return the stops with a verdict on every criterion whose bounds are shares of the dry stop.

    A wet stop that misses one does not pass any more; of one that would pass otherwise, but lacks data for
    one, it is not known.
    """
    for profile in series.criteria:
        for criterion in profile.criteria:
            if criterion.scope == "stop" and criterion.of_dry_stop:
                stops = [_with_relation(series, criterion, stop, stops) for stop in stops]
    return list(stops)


def _with_relation(
    series: Series, criterion: Criterion, stop: SeriesStop, stops: Sequence[SeriesStop]
) -> SeriesStop:
    if stop.role != "wet" or not stop.counts or not applies(series, criterion, stop):
        return stop
    percent, bounds = _percent_of_dry(criterion, stop, stops), evaluation.bounds_of(criterion)
    if math.isfinite(percent):
        decision = evaluation.Decision("pass" if bounds.hold(percent) else "fail", percent, "")
    else:
        lacking = "no value of this stop, or of the dry stop, to compare"
        decision = evaluation.Decision("inconclusive", None, lacking)
    verdict = evaluation.verdict_of(criterion, bounds, decision)
    verdicts = (*(each for each in stop.criteria if each.id != criterion.id), verdict)
    passed = stop.figures.passed
    if verdict.status != "pass":
        passed = None if passed is not False and verdict.status == "inconclusive" else False
    return replace(stop, criteria=verdicts, figures=replace(stop.figures, passed=passed))


def applies(series: Series, criterion: Criterion, stop: SeriesStop) -> bool:
    """Return whether a criterion applies to a stop of a series."""
    planned = next(each for each in series.stops if each.case.id == stop.case)
    scenario = planned.case.scenario
    conditions = scenarios.test_conditions_of(scenario)
    if not planned.rail:
        conditions = conditions._replace(rail_cleaned=None)
    return not scenarios.unmet_conditions(criterion.applies, conditions, float(scenario.initial_speed))


def _percent_of_dry(criterion: Criterion, stop: SeriesStop, stops: Sequence[SeriesStop]) -> float:
    """Return a figure of one stop in % of its mean over the dry stops, as it is; NaN where one is missing."""
    column = MEASURES[criterion.measure].column
    assert column is not None
    figure = of_stop(column.name)
    at_speed = [each for each in stops if each.speed_kmh == stop.speed_kmh]
    dry = tuple(each.figures for each in at_speed if each.role == "dry" and each.counts)
    mean = SpeedStops(stop.speed_kmh * KILOMETRE_PER_HOUR, dry, ()).dry_mean(figure)
    return 100.0 * figure(stop.figures) / mean
