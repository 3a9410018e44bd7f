"""A series judged: its stops counted, its measures computed, its criteria applied."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from uictest import evaluation
from uictest.evaluation import Outcome
from uictest.series.counting import SeriesStop, counts_of, not_counted, observed_stops
from uictest.series.plan.series import Series
from uictest.series.relations import with_relations
from uictest.series.result import Role, SeriesCase, SeriesResult, SeriesVerdict, SpeedResult
from uictest.series.verdicts import verdict_of
from uictest.series_measures import SERIES_MEASURES, SpeedStops
from uictest.units import KILOMETRE_PER_HOUR, in_unit


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
        verdict_of(series, criterion, profile, observed.speeds, stops, observed.too_few)
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
            name: each.of_series(observed.speeds, observed.confidence)
            for name, each in SERIES_MEASURES.items()
        },
        speeds=tuple(map(observed.speed_result, observed.speeds)),
        not_counted=not_counted(stops),
        cases=tuple(cases),
        requirements=series.file.requirements,
        test_case=series.file.test_case or "",
    )


def _require_known(series: Series, cases: Sequence[SeriesCase]) -> None:
    known = {case.id for case in series.cases}
    if unknown := [each.case.id for each in cases if each.case.id not in known]:
        raise ValueError(f"the series {series.id!r} has no case {unknown[0]!r}")


@dataclass(frozen=True)
class _ObservedSeries:
    """The stops of a series by their initial speed."""

    series: Series
    stops: Sequence[SeriesStop]

    @property
    def confidence(self) -> float:
        """The confidence of the intervals."""
        return float(self.series.file.confidence)

    @property
    def speeds(self) -> list[SpeedStops]:
        """The stops that count, by rising speed."""
        return [
            SpeedStops(
                speed * KILOMETRE_PER_HOUR,
                *(tuple(stop.figures for stop in self._at(speed, role) if stop.counts) for role in ROLES),
            )
            for speed in sorted({stop.speed_kmh for stop in self.stops})
        ]

    @property
    def too_few(self) -> str:
        """Why there are too few stops for a verdict; empty where there are enough."""
        return "; ".join(self._shortages())

    def speed_result(self, speed: SpeedStops) -> SpeedResult:
        """Return what the stops from one speed show."""
        kmh = round(speed.speed / KILOMETRE_PER_HOUR, 9)
        at_speed = [stop for stop in self.stops if stop.speed_kmh == kmh]
        return SpeedResult(
            speed_kmh=kmh,
            dry=counts_of(at_speed, "dry"),
            wet=counts_of(at_speed, "wet"),
            measures={name: each.of_speed(speed, self.confidence) for name, each in SERIES_MEASURES.items()},
        )

    def _at(self, speed: float, role: Role) -> list[SeriesStop]:
        return [stop for stop in self.stops if (stop.speed_kmh, stop.role) == (speed, role)]

    def _shortages(self) -> Iterator[str]:
        needed = self.series.file.valid_stops
        for speed in sorted({stop.speed_kmh for stop in self.stops}):
            dry, wet = (counts_of(self._at(speed, role), role) for role in ROLES)
            if not dry.counted:
                yield f"none of {dry.run} dry stops from {speed:g} km/h counts"
            if wet.share < needed:
                yield f"{wet.counted} of {wet.run} wet stops from {speed:g} km/h count, {needed.text} must"


ROLES: tuple[Role, Role] = ("dry", "wet")


def _outcome(stops: Sequence[SeriesStop], verdicts: Sequence[SeriesVerdict]) -> tuple[Outcome, str]:
    failed = [stop for stop in stops if stop.outcome == "error"]
    if failed:
        return "error", f"{len(failed)} of {len(stops)} stops failed to run; {failed[0].reason}"
    return evaluation.outcome_of(each.verdict for each in verdicts)
