"""The verdict of one criterion over a series."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from uictest.core.series_measures import SERIES_MEASURES, Estimate, SeriesValue, SpeedStops
from uictest.core.units import KILOMETRE_PER_HOUR, value_text, with_unit
from uictest.judging import evaluation
from uictest.judging.series.counting import SeriesStop
from uictest.judging.series.result import SeriesVerdict, place_text
from uictest.plans.scenario import Criteria, Criterion
from uictest.plans.series import Series


def verdict_of(
    series: Series,
    criterion: Criterion,
    profile: Criteria,
    speeds: Sequence[SpeedStops],
    stops: Sequence[SeriesStop],
    too_few: str,
) -> SeriesVerdict:
    """Return the verdict of a criterion; inconclusive where there are too few stops, with that reason.

    A criterion of stops holds for a series if every stop that counts, and that it applies to, keeps it.
    """
    over_series = _verdict_of(series, criterion, profile, speeds, stops, too_few)
    return replace(over_series, of_dry_stop=criterion.of_dry_stop)


def _verdict_of(
    series: Series,
    criterion: Criterion,
    profile: Criteria,
    speeds: Sequence[SpeedStops],
    stops: Sequence[SeriesStop],
    too_few: str,
) -> SeriesVerdict:
    definition = evaluation.definition_texts(criterion, profile, series.stops[0].case.scenario)
    if too_few:
        return SeriesVerdict(_verdict(criterion, definition, None, "inconclusive", too_few))
    if criterion.scope == "stop":
        judged = [stop for stop in stops if stop.counts and stop.role != "bypassed"]
        return _over_stops(criterion, definition, judged)
    return _over_series(criterion, definition, speeds, float(series.file.confidence))


def _over_series(
    criterion: Criterion, definition: dict[str, str], speeds: Sequence[SpeedStops], confidence: float
) -> SeriesVerdict:
    """Return the verdict on a measure of series: at the speed and rail that are nearest to missing a bound.

    What counts all stops together does so on each rail: stops on one do not outvote those on another.
    """
    if not speeds:
        reason = "it applies to none of the wet stops"
        return SeriesVerdict(_verdict(criterion, definition, None, "not_applicable", reason))
    measure = SERIES_MEASURES[criterion.measure]
    together = measure.groups(speeds)
    values = [_value(criterion, each, confidence) for each in together]
    estimates = [value.estimate for value in values if value.estimate is not None]
    if len(estimates) < len(values) or not values:
        reason = next((value.unavailable_reason for value in values if value.estimate is None), "no stop")
        return SeriesVerdict(_verdict(criterion, definition, None, "inconclusive", reason))
    bounds = evaluation.bounds_of(criterion)
    margins = [bounds.margin(each.value) for each in estimates]
    deciding = margins.index(min(margins))
    estimate = estimates[deciding]
    status: evaluation.Status = "pass" if bounds.hold(estimate.value) else "fail"
    decisive = together[deciding][0]
    of_one_speed = None if measure.pooled else round(decisive.speed / KILOMETRE_PER_HOUR, 9)
    place = place_text(of_one_speed, decisive.rail)
    reason = "" if status == "pass" else _missed(estimate.value, bounds, criterion, place)
    verdict = _verdict(criterion, definition, estimate.value, status, reason)
    confident = _confident(estimates, bounds, status)
    return SeriesVerdict(verdict, estimate, confident, of_one_speed, rail=decisive.rail)


def _value(criterion: Criterion, speeds: Sequence[SpeedStops], confidence: float) -> SeriesValue:
    measure = SERIES_MEASURES[criterion.measure]
    if criterion.of_dry_stop:
        return measure.percent_of_dry(speeds, confidence)
    return measure.of_series(speeds, confidence)


def _confident(
    estimates: Sequence[Estimate], bounds: evaluation.Bounds, status: evaluation.Status
) -> bool | None:
    """Return whether the verdict is the same wherever in their intervals the values of all speeds lie.

    One speed that misses for certain makes a miss certain. None: for lack of an interval nobody knows. The
    interval of the largest or smallest value is of the dry stops alone: it makes no pass certain. Nor is one
    over dry stops that show no scatter.
    """
    hold = [
        bounds.hold_throughout(each.low, each.high)
        for each in estimates
        if not (math.isnan(each.low) or math.isnan(each.high))
    ]
    if status == "fail" and False in hold:
        return True
    if status == "pass" and (None in hold or not all(each.dry_scatter for each in estimates)):
        return False
    extreme = any(each.method in ("largest", "smallest") for each in estimates)
    if len(hold) < len(estimates) or (status == "pass" and extreme):
        return None
    return status == "pass"


def _over_stops(
    criterion: Criterion, definition: dict[str, str], stops: Sequence[SeriesStop]
) -> SeriesVerdict:
    """Return the verdict on a measure of stops."""
    verdicts = [verdict for stop in stops if (verdict := stop.verdict(criterion.id)) is not None]
    judged = [verdict for verdict in verdicts if verdict.status != "not_applicable"]
    if not judged:
        reason = "it applies to none of the stops that count"
        return SeriesVerdict(_verdict(criterion, definition, None, "not_applicable", reason))
    kept = sum(verdict.status == "pass" for verdict in judged)
    failed = any(verdict.status == "fail" for verdict in judged)
    status: evaluation.Status = "fail" if failed else "pass" if kept == len(judged) else "inconclusive"
    known = [verdict for verdict in judged if verdict.margin is not None]
    worst = min(known, key=lambda verdict: verdict.margin or 0.0).value if known else None
    reason = "" if status == "pass" else f"{kept} of {len(judged)} stops keep it"
    verdict = _verdict(criterion, definition, worst, status, reason)
    return SeriesVerdict(verdict, kept=kept, stops=len(judged))


def _verdict(
    criterion: Criterion,
    definition: dict[str, str],
    value: float | None,
    status: evaluation.Status,
    reason: str,
) -> evaluation.Verdict:
    bounds = evaluation.bounds_of(criterion)
    return evaluation.Verdict(
        id=criterion.id,
        layer=criterion.layer,
        value=value,
        unit=criterion.unit,
        lower=bounds.lower,
        upper=bounds.upper,
        margin=None if value is None else bounds.margin(value),
        status=status,
        reason=reason,
        definition=definition,
        measure=criterion.measure,
        requirements=criterion.requirements,
        in_valid_test=criterion.in_valid_test,
    )


def _missed(value: float, bounds: evaluation.Bounds, criterion: Criterion, place: str) -> str:
    demand = with_unit(str(bounds), criterion.unit)
    missing = value_text(-bounds.margin(value), criterion.unit)
    at_speed = f" from {place}" if place else ""
    return f"{value_text(value, criterion.unit)}{at_speed} misses {demand} by {missing}"
