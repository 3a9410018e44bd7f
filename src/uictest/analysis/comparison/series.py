"""Two runs, series by series; series that were accepted before."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from uictest.analysis.comparison.tolerance import Scope, Tolerances, compare_numbers
from uictest.core.series_measures import SERIES_MEASURES
from uictest.judging.series import SeriesResult
from uictest.report import Difference


def series_differences(
    first: Sequence[SeriesResult], second: Sequence[SeriesResult], tolerances: Tolerances
) -> Iterator[Difference | None]:
    """Yield one item per quantity of the series compared: None where both sides are the same.

    Series are paired by id; one on one side only is a difference.
    """
    ours, theirs = ({result.id: result for result in side} for side in (first, second))
    for name in dict.fromkeys([*ours, *theirs]):
        if name in ours and name in theirs:
            yield from differences_of_series(ours[name], theirs[name], tolerances)
        else:
            before, after = (side[name].outcome if name in side else "missing" for side in (ours, theirs))
            remark = "the series is on one side only"
            yield Difference(name, "series", before, after, within=False, remark=remark)


def differences_of_series(
    first: SeriesResult, second: SeriesResult, tolerances: Tolerances
) -> Iterator[Difference | None]:
    """Yield one item per quantity of a series compared: None where both sides are the same."""
    texts, others = _texts(first), _texts(second)
    for quantity in dict.fromkeys([*texts, *others]):
        sides = texts.get(quantity, "none"), others.get(quantity, "none")
        yield None if sides[0] == sides[1] else Difference(first.id, quantity, *sides, within=False)
    numbers, other_numbers = _numbers(first), _numbers(second)
    for place, name in dict.fromkeys([*numbers, *other_numbers]):
        before, after = (side.get((place, name), math.nan) for side in (numbers, other_numbers))
        quantity = f"{name} from {place}" if place else name
        yield compare_numbers(first.id, quantity, before, after, tolerances, SERIES_MEASURES[name].unit)


def _texts(result: SeriesResult) -> dict[str, str]:
    """Return what of a series is no number: outcome, verdicts, and how many stops count."""
    verdicts = {
        f"criterion {each.verdict.id}": each.verdict.status.replace("_", " ") for each in result.criteria
    }
    counts = {
        f"{role} stops from {speed.place}": f"{each.counted} of {each.run}"
        for speed in result.speeds
        for role, each in (("dry", speed.dry), ("wet", speed.wet))
    }
    return {"outcome": result.outcome, **verdicts, **counts}


def _numbers(result: SeriesResult) -> dict[tuple[str, str], float]:
    """Return the measures of a series, and those of each rail (with its speed) where it has several."""
    tables = {"": result.measures, **{each.place: each.measures for each in result.speeds if each.rail}}
    return {
        (place, name): math.nan if value.estimate is None else value.estimate.value
        for place, measures in tables.items()
        for name, value in measures.items()
    }


@dataclass(frozen=True, slots=True)
class AcceptedSeries:
    """Series against a baseline.

    `quantities` has an item per quantity compared of each series, by its id: None where both sides are the
    same. `files` has the file of each of these series. `not_compared` are ids of accepted series that were
    not run or not selected.
    """

    quantities: Mapping[str, Sequence[Difference | None]]
    files: Mapping[str, str]
    not_compared: Sequence[str]


def compare_accepted_series(
    accepted: Sequence[SeriesResult], run: Sequence[SeriesResult], scope: Scope, tolerances: Tolerances
) -> AcceptedSeries:
    """Compare the series of a run; one that its file no longer has, or that is new, is a difference."""
    before = {result.id: result for result in accepted}
    quantities: dict[str, Sequence[Difference | None]] = {}
    for result in run:
        known = before.pop(result.id, None)
        quantities[result.id] = (
            [_new(result)] if known is None else list(differences_of_series(known, result, tolerances))
        )
    missing = [result for result in before.values() if scope.misses(result.id, result.file)]
    quantities |= {result.id: [_missing(result)] for result in missing}
    return AcceptedSeries(
        quantities,
        {result.id: result.file for result in (*run, *missing)},
        [own_id for own_id in before if own_id not in quantities],
    )


def _new(result: SeriesResult) -> Difference:
    remark = "the baseline has no such series; --accept adds it"
    return Difference(result.id, "series", "missing", result.outcome, within=False, remark=remark)


def _missing(result: SeriesResult) -> Difference:
    remark = f"{result.file} no longer has this series; --accept drops it"
    return Difference(result.id, "series", result.outcome, "missing", within=False, remark=remark)
