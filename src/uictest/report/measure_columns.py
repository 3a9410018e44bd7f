"""The columns of measures in tables of cases and of stops."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Sequence
from typing import Any

from uictest.core import measures
from uictest.core.document import Column
from uictest.judging import evaluation
from uictest.report.case_conditions import slide_speed

Stop = evaluation.CaseResult | evaluation.RepeatedStop


def measure_columns(results: Iterable[Any], failing: Collection[str] = ()) -> list[Column[Any]]:
    """Return the columns of measures: of the stop, and for people the largest of the wheelsets.

    Of those that people see, those named in `failing` are never left out for lack of room.
    """
    results = list(results)
    speed = slide_speed(results)
    columns = []
    for measure in (*measures.STOP_COLUMNS.values(), *measures.WHEELSET_COLUMNS.values()):
        overview = measure.overview
        if overview is not None and _repeats(measure.name, overview.unlike, results):
            overview = None
        rank = 0 if measure.name in failing else overview.rank if overview else 0
        heading = (overview.short or overview.heading).format(speed) if overview else ""
        of_stop = isinstance(measure, measures.StopColumn)
        if of_stop or overview is not None:
            digits = overview.digits if overview else 0
            columns.append(_measure_column(measure, measure.name if of_stop else "", heading, digits, rank))
    return columns


def _repeats(name: str, other: str, results: Sequence[Stop]) -> bool:
    """Return whether a column of stops says the same as another one in every case."""
    measured = [result.measures for result in results if other and result.measures]
    return bool(other) and all(repr(stop.get(name)) == repr(stop.get(other)) for stop in measured)


def _measure_column(measure: measures.Column, key: str, heading: str, digits: int, rank: int) -> Column[Stop]:
    def value(stop: Stop) -> float | None:
        if isinstance(measure, measures.StopColumn):
            return (stop.measures or {}).get(measure.name)
        return max((wheelset[measure.name] for wheelset in stop.wheelsets), default=None)

    def text(stop: Stop) -> str:
        known = value(stop)
        return "-" if known is None or math.isnan(known) else measure.text(known, digits)

    return Column(key=key, heading=heading, value=value, text=text, rank=rank, right=True)
