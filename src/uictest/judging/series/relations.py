"""Stops of a series against the dry stop: criteria of stops whose bounds refer to it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from uictest.core.measures import MEASURES
from uictest.core.series_measures import SpeedStops, of_stop, percent_of_dry
from uictest.core.units import KILOMETRE_PER_HOUR
from uictest.judging import evaluation
from uictest.judging.series.counting import SeriesStop
from uictest.plans import scenario as scenarios
from uictest.plans.scenario import Criterion
from uictest.plans.series import Series


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
        conditions = replace(conditions, rail_cleaned=None)
    return not scenarios.unmet_conditions(criterion.applies, conditions, float(scenario.initial_speed))


def _percent_of_dry(criterion: Criterion, stop: SeriesStop, stops: Sequence[SeriesStop]) -> float:
    column = MEASURES[criterion.measure].column
    assert column is not None
    dry = tuple(
        each.figures
        for each in stops
        if each.role == "dry" and each.counts and each.speed_kmh == stop.speed_kmh
    )
    at_speed = SpeedStops(stop.speed_kmh * KILOMETRE_PER_HOUR, dry, (stop.figures,))
    (percent,) = percent_of_dry(of_stop(column.name), at_speed)
    return percent


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
