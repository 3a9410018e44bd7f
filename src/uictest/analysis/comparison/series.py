"""Two runs: series by series outcome, verdicts, stops that count and measures."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from uictest.analysis.comparison.tolerance import Tolerances, compare_numbers
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
