"""Series of stops, run one after the other and judged when their last stop is there."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from uictest.core.units import in_unit
from uictest.judging import evaluation, series
from uictest.plans import scenario, series as series_plans
from uictest.running import campaign

Simulate = Callable[[Sequence[scenario.Case]], campaign.BatchResult]


@dataclass(slots=True)
class SeriesBatch:
    """The series that were judged, and whether an interrupt ended them."""

    results: list[series.SeriesResult] = field(default_factory=list)
    interrupted: bool = False


def run_series(
    planned: Sequence[series_plans.Series],
    simulate: Simulate,
    *,
    maxfail: int | None,
    show: Callable[[series.SeriesResult], None],
) -> SeriesBatch:
    """Run and judge series; after `maxfail` that are not as expected no further one is run.

    A series whose stops an interrupt cut short is not judged.
    """
    batch = SeriesBatch()
    for each in planned:
        if maxfail is not None and sum(not result.met for result in batch.results) >= maxfail:
            break
        done = simulate(each.cases)
        if done.interrupted:
            batch.interrupted = True
            break
        result = series.judge_series(each, cases_of(each, done.results))
        batch.results.append(result)
        show(result)
    return batch


def cases_of(
    planned: series_plans.Series, results: Sequence[evaluation.CaseResult]
) -> list[series.SeriesCase]:
    """Return the results of the cases of a series, with what each is for and its nominal speed."""
    return [
        series.SeriesCase(stop.role, speed_kmh(stop), result, stop.rail)
        for stop, result in zip(planned.stops, results, strict=True)
    ]


def speed_kmh(stop: series_plans.PlannedStop) -> float:
    """Return the nominal initial speed of a stop in km/h, without the digits that conversion adds."""
    return round(in_unit(stop.speed, "km/h"), 6)
