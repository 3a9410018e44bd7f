"""A series judged: its stops counted, its measures computed, its criteria applied."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from uictest.core.series_measures import SERIES_MEASURES, Rail, SeriesValue, SpeedStops
from uictest.core.units import KILOMETRE_PER_HOUR, in_unit
from uictest.judging import evaluation
from uictest.judging.evaluation import CaseResult, Outcome
from uictest.judging.series.counting import (
    SeriesStop,
    applies,
    counts_of,
    not_counted,
    observed_stops,
    with_relations,
)
from uictest.judging.series.result import (
    SeriesCase,
    SeriesResult,
    SeriesVerdict,
    SpeedResult,
    place_text,
)
from uictest.judging.series.verdicts import verdict_of
from uictest.plans.scenario import Criterion
from uictest.plans.series import Role, Series


def judge_series(series: Series, cases: Sequence[SeriesCase]) -> SeriesResult:
    """Return the result of a series whose cases were simulated, recorded, or read back from a document.

    Columns, verdicts and outcomes of the stops are all that is used. A stop that is no test, or was not
    judged, does not count. Where too few wet stops count, or no dry one, nothing is decided.

    Raises ValueError for a case that the series does not have.
    """
    _require_known(series, cases)
    tolerance = round(in_unit(series.file.speed_tolerance, "km/h"), 9)
    stops = with_relations(series, observed_stops(cases, tolerance))
    observed = _ObservedSeries(series, stops)
    verdicts = tuple(
        verdict_of(series, criterion, profile, observed.judged_by(criterion), stops, observed.too_few)
        for profile, criterion in series.judged_criteria
    )
    outcome, reason = _outcome(stops, verdicts)
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


def _require_known(series: Series, cases: Sequence[SeriesCase]) -> None:
    known = {case.id for case in series.cases}
    if unknown := [each.case.id for each in cases if each.case.id not in known]:
        raise ValueError(f"the series {series.id!r} has no case {unknown[0]!r}")


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
        return self._groups([stop for stop in self.stops if stop.role == "wet"])

    def judged_by(self, criterion: Criterion) -> list[SpeedStops]:
        """Return of these the ones that a criterion applies to, with the dry ones as their reference."""
        return [group for group in self._groups(self._that(criterion, "wet")) if group.wet]

    @property
    def bypassed_k_wet(self) -> SeriesValue | None:
        """K_wet with the WSP bypassed, over the stops by which it is judged; None where it is not."""
        of_k_wet = [each for _, each in self.series.judged_criteria if each.measure == "k_wet"]
        stops = [stop for each in of_k_wet[:1] for stop in self._that(each, "bypassed")]
        groups = [group for group in self._groups(stops) if group.wet]
        return SERIES_MEASURES["k_wet"].of_series(groups, self.confidence) if groups else None

    def _that(self, criterion: Criterion, role: Role) -> list[SeriesStop]:
        """Return the stops of a role that a criterion applies to."""
        return [s for s in self.stops if s.role == role and applies(self.series, criterion, s)]

    def _groups(self, slippery: Sequence[SeriesStop]) -> list[SpeedStops]:
        """Return at every place those of some stops that count, as wet ones, with the dry ones from there."""
        groups = []
        for speed, rail in self.places:
            at_place = [each for each in slippery if each.speed_kmh == speed and rail in ("", each.rail)]
            dry, wet = (
                tuple(stop.figures for stop in stops if stop.counts)
                for stops in (self._at(speed, "dry"), at_place)
            )
            groups.append(SpeedStops(speed * KILOMETRE_PER_HOUR, dry, wet, rail))
        return groups

    @property
    def too_few(self) -> str:
        """Why there are too few stops for a verdict; empty where there are enough."""
        return "; ".join(dict.fromkeys(self._shortages()))

    def speed_result(self, speed: SpeedStops) -> SpeedResult:
        """Return what the stops from one speed show."""
        kmh = round(speed.speed / KILOMETRE_PER_HOUR, 9)
        return SpeedResult(
            speed_kmh=kmh,
            rail=speed.rail,
            dry=counts_of(self._at(kmh, "dry"), "dry"),
            wet=counts_of(self._at(kmh, "wet", speed.rail), "wet"),
            measures={name: each.of_speed(speed, self.confidence) for name, each in SERIES_MEASURES.items()},
        )

    def _at(self, speed: float, role: Role, rail: Rail = "") -> list[SeriesStop]:
        at_speed = [stop for stop in self.stops if (stop.speed_kmh, stop.role) == (speed, role)]
        return [stop for stop in at_speed if rail in ("", stop.rail)]

    def _shortages(self) -> Iterator[str]:
        needed = self.series.file.valid_stops
        for speed, rail in self.places:
            dry, wet = (
                counts_of(self._at(speed, "dry"), "dry"),
                counts_of(self._at(speed, "wet", rail), "wet"),
            )
            if not dry.counted:
                yield f"none of {dry.run} dry stops from {speed:g} km/h counts"
            if wet.share < needed:
                place = place_text(speed, rail)
                yield f"{wet.counted} of {wet.run} wet stops from {place} count, {needed.text} must"


def _outcome(stops: Sequence[SeriesStop], verdicts: Sequence[SeriesVerdict]) -> tuple[Outcome, str]:
    failed = [stop for stop in stops if stop.not_counted == "error"]
    if failed:
        return "error", f"{len(failed)} of {len(stops)} stops failed to run; {failed[0].reason}"
    return evaluation.outcome_of(each.verdict for each in verdicts)
