"""A series judged: its measures computed, its criteria applied."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from uictest.core.series_measures import SERIES_MEASURES, Estimate, Rail, SeriesValue, SpeedStops
from uictest.core.units import KILOMETRE_PER_HOUR, in_unit, value_text
from uictest.judging import evaluation
from uictest.judging.evaluation import CaseResult
from uictest.judging.series.counting import (
    SeriesStop,
    applies,
    counts_of,
    not_counted,
    observed_stops,
    with_relations,
)
from uictest.judging.series.result import SeriesCase, SeriesResult, SeriesVerdict, SpeedResult, place_text
from uictest.plans.scenario import Criteria, Criterion
from uictest.plans.series import Role, Series


def judge_series(series: Series, cases: Sequence[SeriesCase]) -> SeriesResult:
    """Return the result of a series whose cases were simulated, recorded, or read back from a document.

    Columns, verdicts and outcomes of the stops are all that is used. A stop that is not a test, or was not
    judged, does not count. Where too few wet stops count, or no dry one, nothing is decided.

    Raises ValueError for a case that the series does not have.
    """
    known = {case.id for case in series.cases}
    if unknown := [each.case.id for each in cases if each.case.id not in known]:
        raise ValueError(f"the series {series.id!r} has no case {unknown[0]!r}")
    tolerance = round(in_unit(series.file.speed_tolerance, "km/h"), 9)
    stops = with_relations(series, observed_stops(cases, tolerance))
    observed = _ObservedSeries(series, stops)
    too_few = "; ".join(dict.fromkeys(observed.shortages()))
    verdicts = tuple(
        _verdict_of(series, criterion, profile, observed.judged_by(criterion), stops, too_few)
        for profile, criterion in series.judged_criteria
    )
    outcome, reason = evaluation.outcome_of(each.verdict for each in verdicts)
    if failed := [stop for stop in stops if stop.not_counted == "error"]:
        outcome, reason = "error", f"{len(failed)} of {len(stops)} stops failed to run; {failed[0].reason}"
    return SeriesResult(
        id=series.id,
        file=series.path.as_posix(),
        title=series.file.title,
        parameters=dict(series.parameters),
        expect=series.file.expect,
        outcome=outcome,
        reason=reason,
        confidence=observed.confidence,
        valid_stops=float(series.file.valid_stops),
        speed_tolerance_kmh=tolerance,
        criteria=verdicts,
        measures={
            name: SeriesValue(unavailable_reason="stated for each rail")
            if observed.has_rails
            else each.of_series(observed.speeds, observed.confidence)
            for name, each in SERIES_MEASURES.items()
        },
        speeds=tuple(map(observed.speed_result, observed.speeds)),
        not_counted=not_counted(stops),
        cases=tuple(cases),
        requirements=series.file.requirements,
        test_case=series.file.test_case or "",
        bypassed_k_wet=observed.bypassed_k_wet,
    )


def judge_results(series: Series, results: Sequence[CaseResult]) -> SeriesResult:
    """Return the result of a series all of whose stops have been run; `results` are in their order."""
    cases = [
        SeriesCase(stop.role, stop.speed_kmh, result, stop.rail)
        for stop, result in zip(series.stops, results, strict=True)
    ]
    return judge_series(series, cases)


@dataclass(frozen=True)
class _ObservedSeries:
    """The stops of a series by their initial speed and kind of rail."""

    series: Series
    stops: Sequence[SeriesStop]

    @property
    def confidence(self) -> float:
        """The confidence of the intervals."""
        return float(self.series.file.confidence)

    @property
    def has_rails(self) -> bool:
        """Whether the wet stops are on several kinds of rail, which are not pooled then."""
        return len({stop.rail for stop in self.stops if stop.role == "wet"}) > 1

    @property
    def places(self) -> list[tuple[float, Rail]]:
        """The initial speeds (km/h), each with the kinds of rail of its wet stops; one rail is not named."""
        rails = {
            (stop.speed_kmh, stop.rail if self.has_rails else "") for stop in self.stops if stop.role == "wet"
        }
        alone = {stop.speed_kmh for stop in self.stops} - {speed for speed, _ in rails}
        return sorted({*rails, *((speed, "") for speed in alone)})

    @property
    def speeds(self) -> list[SpeedStops]:
        """The stops that count, by rising speed."""
        return self._stops_by_speed([stop for stop in self.stops if stop.role == "wet"])

    def judged_by(self, criterion: Criterion) -> list[SpeedStops]:
        """Return of these the ones that a criterion applies to, with the dry ones as their reference."""
        groups = self._stops_by_speed(self._applicable_stops(criterion, "wet"))
        return [group for group in groups if group.wet]

    @property
    def bypassed_k_wet(self) -> SeriesValue | None:
        """K_wet with the WSP bypassed, over the stops by which it is judged; None where it is not."""
        of_k_wet = [each for _, each in self.series.judged_criteria if each.measure == "k_wet"]
        stops = [stop for each in of_k_wet[:1] for stop in self._applicable_stops(each, "bypassed")]
        groups = [group for group in self._stops_by_speed(stops) if group.wet]
        return SERIES_MEASURES["k_wet"].of_series(groups, self.confidence) if groups else None

    def _applicable_stops(self, criterion: Criterion, role: Role) -> list[SeriesStop]:
        return [s for s in self.stops if s.role == role and applies(self.series, criterion, s)]

    def _stops_by_speed(self, slippery: Sequence[SeriesStop]) -> list[SpeedStops]:
        """Return a group per speed and rail: the dry stops and, as wet ones, the slippery ones that count."""
        groups = []
        for speed, rail in self.places:
            at_place = [each for each in slippery if each.speed_kmh == speed and rail in ("", each.rail)]
            dry, wet = (
                tuple(stop.figures for stop in stops if stop.counts)
                for stops in (self._stops_from(speed, "dry"), at_place)
            )
            groups.append(SpeedStops(speed * KILOMETRE_PER_HOUR, dry, wet, rail))
        return groups

    def speed_result(self, speed: SpeedStops) -> SpeedResult:
        """Return the counts and measures of the stops from one speed."""
        kmh = round(speed.speed / KILOMETRE_PER_HOUR, 9)
        return SpeedResult(
            speed_kmh=kmh,
            rail=speed.rail,
            dry=counts_of(self._stops_from(kmh, "dry")),
            wet=counts_of(self._stops_from(kmh, "wet", speed.rail)),
            measures={name: each.of_speed(speed, self.confidence) for name, each in SERIES_MEASURES.items()},
        )

    def _stops_from(self, speed: float, role: Role, rail: Rail = "") -> list[SeriesStop]:
        at_speed = [stop for stop in self.stops if (stop.speed_kmh, stop.role) == (speed, role)]
        return [stop for stop in at_speed if rail in ("", stop.rail)]

    def shortages(self) -> Iterator[str]:
        """Yield the reasons why there are too few stops for a verdict; none where there are enough."""
        needed = self.series.file.valid_stops
        for speed, rail in self.places:
            dry = counts_of(self._stops_from(speed, "dry"))
            wet = counts_of(self._stops_from(speed, "wet", rail))
            if not dry.counted:
                yield f"none of {dry.run} dry stops from {speed:g} km/h counts"
            if wet.share < needed:
                place = place_text(speed, rail)
                yield f"{wet.counted} of {wet.run} wet stops from {place} count, {needed.text} must"


def _verdict_of(
    series: Series,
    criterion: Criterion,
    profile: Criteria,
    speeds: Sequence[SpeedStops],
    stops: Sequence[SeriesStop],
    too_few: str,
) -> SeriesVerdict:
    """Return the verdict of a criterion; inconclusive where there are too few stops, with that reason."""
    if too_few:
        over_series = SeriesVerdict(_without_value(criterion, "inconclusive", too_few))
    elif criterion.scope == "stop":
        counted = [stop for stop in stops if stop.counts and stop.role != "bypassed"]
        over_series = _over_stops(criterion, counted)
    else:
        over_series = _over_series(criterion, speeds, float(series.file.confidence))
    texts = evaluation.definition_texts(criterion, profile, series.stops[0].case.scenario)
    verdict = replace(over_series.verdict, definition=texts)
    return replace(over_series, verdict=verdict, of_dry_stop=criterion.of_dry_stop)


def _without_value(criterion: Criterion, status: evaluation.Status, reason: str) -> evaluation.Verdict:
    decision = evaluation.Decision(status, None, reason)
    return evaluation.verdict_of(criterion, evaluation.bounds_of(criterion), decision)


def _over_stops(criterion: Criterion, stops: Sequence[SeriesStop]) -> SeriesVerdict:
    """Return the verdict on a measure of stops: it holds if every stop that it applies to keeps it."""
    verdicts = [verdict for stop in stops if (verdict := stop.verdict(criterion.id)) is not None]
    judged = [verdict for verdict in verdicts if verdict.status != "not_applicable"]
    if not judged:
        reason = "it applies to none of the stops that count"
        return SeriesVerdict(_without_value(criterion, "not_applicable", reason))
    kept = sum(verdict.status == "pass" for verdict in judged)
    failed = any(verdict.status == "fail" for verdict in judged)
    status: evaluation.Status = "fail" if failed else "pass" if kept == len(judged) else "inconclusive"
    known = [verdict for verdict in judged if verdict.margin is not None]
    worst = min(known, key=lambda verdict: verdict.margin or 0.0).value if known else None
    reason = "" if status == "pass" else f"{kept} of {len(judged)} stops keep it"
    decision = evaluation.Decision(status, worst, reason)
    verdict = evaluation.verdict_of(criterion, evaluation.bounds_of(criterion), decision)
    return SeriesVerdict(verdict, kept=kept, stops=len(judged))


def _over_series(criterion: Criterion, speeds: Sequence[SpeedStops], confidence: float) -> SeriesVerdict:
    """Return the verdict on a measure of series: at the speed and rail that are nearest to missing a bound.

    What counts all stops together does so on each rail: stops on one do not outvote those on another.
    """
    if not speeds:
        reason = "it applies to none of the wet stops"
        return SeriesVerdict(_without_value(criterion, "not_applicable", reason))
    measure = SERIES_MEASURES[criterion.measure]
    value_over = measure.percent_of_dry if criterion.of_dry_stop else measure.of_series
    together = measure.groups(speeds)
    values = [value_over(group, confidence) for group in together]
    estimates = [value.estimate for value in values if value.estimate is not None]
    if len(estimates) < len(values) or not values:
        reason = next((value.unavailable_reason for value in values if value.estimate is None), "no stop")
        return SeriesVerdict(_without_value(criterion, "inconclusive", reason))
    bounds = evaluation.bounds_of(criterion)
    margins = [bounds.margin(estimate.value) for estimate in estimates]
    deciding = margins.index(min(margins))
    estimate, decisive = estimates[deciding], together[deciding][0]
    of_one_speed = None if measure.pooled else round(decisive.speed / KILOMETRE_PER_HOUR, 9)
    status: evaluation.Status = "pass" if bounds.hold(estimate.value) else "fail"
    reason = ""
    if status == "fail":
        position = place_text(of_one_speed, decisive.rail)
        value = value_text(estimate.value, bounds.unit) + (f" from {position}" if position else "")
        reason = f"{value} misses {bounds.text} by {value_text(-margins[deciding], bounds.unit)}"
    verdict = evaluation.verdict_of(criterion, bounds, evaluation.Decision(status, estimate.value, reason))
    confident = _confident(estimates, bounds, status)
    return SeriesVerdict(verdict, estimate, confident, of_one_speed, rail=decisive.rail)


def _confident(
    estimates: Sequence[Estimate], bounds: evaluation.Bounds, status: evaluation.Status
) -> bool | None:
    """Return whether the verdict is the same wherever in their intervals the values of all speeds lie.

    One speed that misses for certain makes a miss certain. None: for lack of an interval nobody knows. The
    interval of the largest or smallest value is of the dry stops alone: it makes no pass certain. Nor is one
    over dry stops that show no scatter.
    """
    hold = [
        bounds.hold_throughout(estimate.low, estimate.high)
        for estimate in estimates
        if not (math.isnan(estimate.low) or math.isnan(estimate.high))
    ]
    if status == "fail" and False in hold:
        return True
    if status == "pass" and (None in hold or not all(estimate.dry_scatter for estimate in estimates)):
        return False
    extreme = any(estimate.method in ("largest", "smallest") for estimate in estimates)
    if len(hold) < len(estimates) or (status == "pass" and extreme):
        return None
    return status == "pass"
