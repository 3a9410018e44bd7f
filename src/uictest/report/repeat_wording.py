"""The stops of repeated cases in words and in cells of tables."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final

from uictest.core import statistics
from uictest.core.document import Cell
from uictest.judging import evaluation

SHARE_COLUMNS: Final = ("stops", "passed", "share", "share_low", "share_high")
"""Columns of a table of cases that say how many stops came out as `pass`, and the interval of their share."""

_COUNTS: Final = ("passed", "failed", "inconclusive", "not_applicable")

CRITERION_COLUMNS: Final = ("stops", *_COUNTS, "share", "share_low", "share_high", "lowest", "highest")
"""Columns of a table of criteria that say how one came out over the stops of a case."""

_ORDER: Final = ("pass", "fail", "invalid", "inconclusive", "skipped", "error")


def any_repeated(results: Iterable[evaluation.CaseResult]) -> bool:
    """Return whether one of the cases repeats its stop."""
    return any(result.repeats is not None for result in results)


def stops_text(result: evaluation.CaseResult) -> str:
    """Return how many stops came out as expected, e.g. `pass 6/10`; empty for a case with one stop."""
    repeats = result.repeats
    if repeats is None:
        return ""
    if repeats.none_judged:
        return f"skipped {len(repeats.stops)}"
    return f"{_expected(result)} {repeats.as_expected(result.expect)}/{len(repeats.stops)}"


def _expected(result: evaluation.CaseResult) -> str:
    return "as expected" if result.expect.is_allowance else result.expect.outcome


def repeat_sentences(result: evaluation.CaseResult) -> Iterator[str]:
    """Yield how the stops of a repeated case came out, and what their number can show; else nothing."""
    repeats = result.repeats
    if repeats is None:
        return
    stops, expected = len(repeats.stops), repeats.as_expected(result.expect)
    first, last = repeats.stops[0].seed, repeats.stops[-1].seed
    outcomes = ", ".join(_counted_outcome(repeats, outcome) for outcome in _ORDER if repeats.seeds(outcome))
    if repeats.none_judged:
        yield f"{stops} stops, seeds {first}..{last}: all skipped; none was judged"
        return
    interval = statistics.proportion_interval(expected, stops)
    low, high = (f"{100 * end:.3g}" for end in interval)
    share = f"{_expected(result)} {100 * expected / stops:.3g} % ({low} .. {high} % with 95 % confidence)"
    yield f"{stops} stops, seeds {first}..{last}: {outcomes}; {share}; rule: {rule_text(repeats)}"
    yield from _support(repeats, interval)


def _counted_outcome(repeats: evaluation.Repeats, outcome: evaluation.Outcome) -> str:
    seeds = repeats.seeds(outcome)
    if len(seeds) == len(repeats.stops):
        return f"all {outcome}"
    return f"{len(seeds)} {outcome} ({evaluation.seeds_text(seeds)})"


def rule_text(repeats: evaluation.Repeats) -> str:
    """Return the rule of a repeated case: `all`, `median` or `at least 90 %`."""
    if repeats.required_share is None:
        return repeats.rule
    return f"at least {100 * repeats.required_share:g} %"


def _support(repeats: evaluation.Repeats, interval: tuple[float, float]) -> Iterator[str]:
    """Yield what the stops cannot show of the share that they must have."""
    required = repeats.required_share
    if required is None or interval[0] >= required:
        return
    needed = statistics.trials_needed(required)
    share = f"{100 * required:g} %"
    if needed is None:
        yield f"no number of stops shows a share of {share}"
    elif needed > len(repeats.stops):
        stops = f"{len(repeats.stops)} stops cannot show a share of {share} with 95 % confidence"
        yield f"{stops}: that takes {needed}, all as expected"
    else:
        yield f"these stops do not show a share of {share}: its 95 % interval begins below"


def drawn_sentence(result: evaluation.CaseResult) -> str:
    """Return which of the stops of a repeated case is recorded and drawn; empty for a case with one stop."""
    if result.repeats is None:
        return ""
    first = result.repeats.stops[0]
    return f"the stop that is recorded and drawn is the first, of seed {first.seed}: {first.outcome}"


def band_text(result: evaluation.CaseResult, stops: int) -> str:
    """Return what a band behind the lines of the drawn stop spans; empty where there is none.

    Args:
        result: of the case.
        stops: that the band holds, the first ones; 0 without a band.

    """
    if result.repeats is None or not stops:
        return ""
    of_all = len(result.repeats.stops)
    which = f"{stops}" if stops == of_all else f"the first {stops} of {of_all}"
    return f"lowest and highest of {which} repeats, of those still running"


def share_cells(result: evaluation.CaseResult) -> dict[str, Cell]:
    """Return the cells of `SHARE_COLUMNS`; none for a case with one stop."""
    repeats = result.repeats
    if repeats is None:
        return {}
    values = len(repeats.stops), repeats.passed, repeats.share, *repeats.interval
    return dict(zip(SHARE_COLUMNS, values, strict=True))


def range_columns(columns: Iterable[str]) -> list[str]:
    """Return the columns that hold the lowest and the highest value of columns over the stops of a case."""
    return [f"{name}_{end}" for name in columns for end in ("lowest", "highest")]


def range_cells(
    result: evaluation.CaseResult, columns: Iterable[str], wheelset: int | None = None
) -> dict[str, Cell]:
    """Return the cells of `range_columns` of the stop, or of one wheelset; none for a case with one stop."""
    repeats, cells = result.repeats, dict[str, Cell]()
    for name in columns if repeats else ():
        spread = evaluation.spread_of(repeats.values(name, wheelset) if repeats else ())
        if spread is not None:
            cells |= {f"{name}_lowest": spread.lowest, f"{name}_highest": spread.highest}
    return cells


def criterion_share_cells(verdict: evaluation.Verdict) -> dict[str, Cell]:
    """Return the cells of `CRITERION_COLUMNS`; none for a verdict on one stop.

    The share is that of the stops that pass among those that the criterion applies to.
    """
    counts = verdict.over_stops
    if counts is None:
        return {}
    numbers = {name: getattr(counts, name) for name in _COUNTS}
    cells: dict[str, Cell] = {
        "stops": counts.stops,
        **numbers,
        "lowest": counts.lowest,
        "highest": counts.highest,
    }
    applicable = counts.stops - counts.not_applicable
    if applicable:
        low, high = statistics.proportion_interval(counts.passed, applicable)
        cells |= {"share": counts.passed / applicable, "share_low": low, "share_high": high}
    return cells


def stop_rows(results: Iterable[evaluation.CaseResult]) -> Iterator[dict[str, Cell]]:
    """Yield one row per stop of every repeated case: seed, outcome, why, its measures, those of wheelsets."""
    for result in results:
        for stop in result.repeats.stops if result.repeats else ():
            own: dict[str, Cell] = {"id": result.id, "seed": stop.seed, "outcome": stop.outcome}
            own["test_validity"] = evaluation.validity_of(stop.criteria)
            own["requirement_status"] = evaluation.requirements_of(stop.criteria)
            wheelsets = {
                f"{name}_{position}": value
                for position, wheelset in enumerate(stop.wheelsets, start=1)
                for name, value in wheelset.items()
            }
            yield {**own, "reason": stop.reason, **(stop.measures or {}), **wheelsets}
