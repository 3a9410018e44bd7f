"""The stops of a repeated case on a page: a strip of outcomes, dots for each criterion, tables."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any, Final, NamedTuple

from uictest.core import document
from uictest.core.measures import STOP_COLUMNS, WHEELSET_COLUMNS, Column
from uictest.judging import evaluation
from uictest.report.case_table import measure_columns
from uictest.report.repeat_wording import drawn_sentence, repeat_sentences
from uictest.report.text_tables import number_cell
from uictest.report.traces.quantities import WHEELSETS
from uictest.report.verdict_sentences import failing_first, without_checks_that_hold

MOST_STOPS = 100
"""Stops that are listed and drawn one by one; the numbers and the counts are those of all."""

_AIR = 0.08
"""Of the range of values and limits: what is left free on both sides; chosen."""


class Dot(NamedTuple):
    """The value of one stop at `x` per cent of the scale, and its status; `row` keeps dots apart."""

    x: float
    row: int
    status: evaluation.Status
    seed: int
    value: float


class CriterionDots(NamedTuple):
    """The values of a criterion over the stops, on a scale of 100 that holds its bounds.

    `first` and `last` are the ends of what the bounds allow, `median` the place of the median; None where no
    stop has a value.
    """

    verdict: evaluation.Verdict
    counts: evaluation.OverStops
    first: float
    last: float
    median: float | None
    dots: Sequence[Dot]


class _MeasureSpread(NamedTuple):
    """Median and spread of one column of results; `wheelset` is None for one of the stop."""

    column: Column
    wheelset: int | None
    spread: evaluation.Spread


def _number(heading: str, name: str) -> document.Column[_MeasureSpread]:
    return document.Column(
        heading=heading, text=lambda each: number_cell(getattr(each.spread, name), ".4g"), right=True
    )


_SPREADS: Final[tuple[document.Column[_MeasureSpread], ...]] = (
    document.Column(heading="measure", text=lambda each: each.column.name, literal=True),
    document.Column(heading="wheelset", text=lambda each: str(each.wheelset or "")),
    _number("lowest", "lowest"),
    _number("quartile", "lower_quartile"),
    _number("median", "median"),
    _number("quartile", "upper_quartile"),
    _number("highest", "highest"),
    document.Column(heading="unit", text=lambda each: each.column.unit.removeprefix("1")),
    document.Column(heading="stops", text=lambda each: str(each.spread.count), right=True),
)


class RepeatsView(NamedTuple):
    """The stops of a case, those listed, and how many are not."""

    sentences: Sequence[str]
    drawn: str
    criteria: Sequence[CriterionDots]
    spreads: document.Table
    stops: document.Table
    more: int


def repeats_view(result: evaluation.CaseResult) -> RepeatsView | None:
    """Return the view of the stops of a case; None for a case with one stop."""
    repeats = result.repeats
    if repeats is None:
        return None
    return RepeatsView(
        sentences=list(repeat_sentences(result)),
        drawn=drawn_sentence(result),
        criteria=list(_criteria(result, repeats)),
        spreads=document.Table(_SPREADS, list(_spreads(repeats))),
        stops=_stops(result, repeats),
        more=max(len(repeats.stops) - MOST_STOPS, 0),
    )


def _criteria(result: evaluation.CaseResult, repeats: evaluation.Repeats) -> Iterator[CriterionDots]:
    for verdict in failing_first(without_checks_that_hold(result.criteria)):
        counts = verdict.over_stops
        if counts is not None and counts.lowest is not None and counts.highest is not None:
            yield _dots(verdict, counts, repeats.stops[:MOST_STOPS])


def _dots(
    verdict: evaluation.Verdict, counts: evaluation.OverStops, stops: Sequence[evaluation.RepeatedStop]
) -> CriterionDots:
    ends = [counts.lowest, counts.highest, verdict.lower, verdict.upper]
    known = [end for end in ends if end is not None and math.isfinite(end)]
    low, high = min(known), max(known)
    air = _AIR * (high - low) or 1.0

    def at(value: float) -> float:
        return round(100 * (value - low + air) / (high - low + 2 * air), 1)

    dots: list[Dot] = []
    taken: dict[int, int] = {}
    for stop in stops:
        own = stop.verdict(verdict.id)
        if own is not None and own.value is not None and math.isfinite(own.value):
            x = at(own.value)
            taken[round(x)] = row = taken.get(round(x), -1) + 1
            dots.append(Dot(x, row, own.status, stop.seed, own.value))
    first = 0.0 if verdict.lower is None else at(verdict.lower)
    last = 100.0 if verdict.upper is None else at(verdict.upper)
    median = None if verdict.value is None else at(verdict.value)
    return CriterionDots(verdict, counts, first, last, median, dots)


def _stops(result: evaluation.CaseResult, repeats: evaluation.Repeats) -> document.Table:
    columns: list[document.Column[Any]] = [
        document.Column(heading="seed", text=lambda stop: str(stop.seed), literal=True, right=True),
        document.Column(heading="outcome", text=lambda stop: stop.outcome),
        *measure_columns([result]),
        document.Column(heading="why", text=lambda stop: stop.reason, wraps=True),
    ]
    return document.Table(columns, repeats.stops[:MOST_STOPS])


def _spreads(repeats: evaluation.Repeats) -> Iterator[_MeasureSpread]:
    """Yield the spread of every column that is not the same in all stops."""
    of_stop = ((column, None) for column in STOP_COLUMNS.values())
    of_wheelsets = ((column, wheelset) for column in WHEELSET_COLUMNS.values() for wheelset in WHEELSETS)
    for column, wheelset in (*of_stop, *of_wheelsets):
        spread = evaluation.spread_of(repeats.values(column.name, wheelset))
        if spread is not None and spread.lowest != spread.highest:
            yield _MeasureSpread(column, wheelset, spread)
