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
from uictest.judging.series.result import NOT_COUNTED, SeriesCase, StopCounts, UncountedStop
from uictest.plans import scenario as scenarios
from uictest.plans.scenario import Criterion
from uictest.plans.series import Role, Series


@dataclass(frozen=True, slots=True)
class SeriesStop:
    """One stop of a case: itself, or one of its repeats."""

    role: Role
    speed_kmh: float
    rail: Rail
    case: str
    seed: int | None
    outcome: Outcome
    reason: str
    criteria: tuple[Verdict, ...]
    figures: CountedStop

    @property
    def counts(self) -> bool:
        """Whether the stop counts as a test: its own criteria were judged, and those of validity hold."""
        return self.outcome not in NOT_COUNTED

    def verdict(self, criterion: str) -> Verdict | None:
        """Return its verdict on a criterion, None where it has none."""
        return next((each for each in self.criteria if each.id == criterion), None)


def observed_stops(cases: Sequence[SeriesCase], speed_tolerance_kmh: float) -> list[SeriesStop]:
    """Return all stops of cases, repeats one by one.

    A stop whose initial speed is farther from the nominal one than the tolerance (km/h) is invalid: distances
    are not corrected for it.
    """
    return [stop for each in cases for stop in _stops_of_case(each, speed_tolerance_kmh)]


def _stops_of_case(each: SeriesCase, tolerance: float) -> Iterator[SeriesStop]:
    case = each.case
    for seed, stop in _observed(case):
        other_speed = _other_speed(stop.measures or {}, each.speed_kmh, tolerance)
        yield SeriesStop(
            role=each.role,
            speed_kmh=each.speed_kmh,
            rail=each.rail,
            case=case.id,
            seed=seed,
            outcome="invalid" if other_speed and stop.outcome not in NOT_COUNTED else stop.outcome,
            reason="; ".join(filter(None, (stop.reason, other_speed))),
            criteria=stop.criteria,
            figures=CountedStop(dict(stop.measures or {}), tuple(stop.wheelsets), stop.outcome == "pass"),
        )


def _observed(case: CaseResult) -> Iterator[tuple[int | None, CaseResult | RepeatedStop]]:
    """Yield the stops of a case, each with its seed; a stop that is not repeated is the case, without one."""
    if case.repeats is None:
        yield None, case
    else:
        yield from ((stop.seed, stop) for stop in case.repeats.stops)


def _other_speed(measures: Mapping[str, float], nominal: float, tolerance: float) -> str:
    """Return why the initial speed is not the nominal one (km/h); empty where it is, or is not known."""
    distance = measures.get("braking_distance_m", math.nan)
    deceleration = measures.get("mean_deceleration_mps2", math.nan)
    # The mean deceleration is v0^2 / (2 s).
    initial = in_unit(math.sqrt(max(2.0 * deceleration * distance, 0.0)), "km/h")
    if not abs(initial - nominal) > tolerance * (1.0 + 1e-9) + 1e-6:
        return ""
    return f"initial speed is {initial:.4g} km/h, nominal {nominal:g} +- {tolerance:g} km/h"


def counts_of(stops: Sequence[SeriesStop], role: Role) -> StopCounts:
    """Return how many stops of a role there are, and how many count."""
    of_role = [stop for stop in stops if stop.role == role]
    return StopCounts(len(of_role), sum(stop.counts for stop in of_role))


def not_counted(stops: Sequence[SeriesStop]) -> tuple[UncountedStop, ...]:
    """Return the stops that do not count, with the reason of each."""
    return tuple(
        UncountedStop(stop.case, stop.role, stop.seed, stop.outcome, stop.reason)
        for stop in stops
        if not stop.counts
    )


def with_relations(series: Series, stops: Sequence[SeriesStop]) -> list[SeriesStop]:
    """Return the stops with a verdict on every criterion whose bounds are shares of the dry stop.

    A wet stop that misses one does not pass any more. One that would pass otherwise, but lacks data for one,
    is inconclusive.
    """
    criteria = [
        criterion
        for profile in series.criteria
        for criterion in profile.criteria
        if criterion.scope == "stop" and criterion.of_dry_stop
    ]
    for criterion in criteria:
        stops = [_judged(series, criterion, stop, stops) for stop in stops]
    return list(stops)


def _judged(
    series: Series, criterion: Criterion, stop: SeriesStop, stops: Sequence[SeriesStop]
) -> SeriesStop:
    if stop.role != "wet" or not stop.counts or not applies(series, criterion, stop):
        return stop
    verdict = _verdict(criterion, _percent_of_dry(criterion, stop, stops))
    verdicts = (*(each for each in stop.criteria if each.id != criterion.id), verdict)
    if stop.figures.passed and verdict.status == "inconclusive":
        reason = f"{criterion.id}: {verdict.reason}"
        return replace(stop, criteria=verdicts, outcome="inconclusive", reason=reason)
    passed = stop.figures.passed and verdict.status == "pass"
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
    dry = tuple(
        each.figures
        for each in stops
        if each.role == "dry" and each.counts and each.speed_kmh == stop.speed_kmh
    )
    mean = SpeedStops(stop.speed_kmh * KILOMETRE_PER_HOUR, dry, ()).dry_mean(figure)
    return 100.0 * figure(stop.figures) / mean


def _verdict(criterion: Criterion, percent: float) -> evaluation.Verdict:
    bounds = evaluation.bounds_of(criterion)
    known = math.isfinite(percent)
    held = bounds.hold(percent)
    return evaluation.Verdict(
        id=criterion.id,
        layer=criterion.layer,
        value=percent if known else None,
        unit=criterion.unit,
        lower=bounds.lower,
        upper=bounds.upper,
        margin=bounds.margin(percent) if known else None,
        status="inconclusive" if not known else "pass" if held else "fail",
        reason="" if known else "no value of this stop, or of the dry stop, to compare",
        measure=criterion.measure,
    )
