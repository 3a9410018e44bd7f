"""The cases of a run as a table: one list of columns for every format that people read."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable
from functools import partial
from typing import Any, Final

from uictest.core import measures
from uictest.core.document import Column, Table
from uictest.judging import evaluation
from uictest.report.case_words import tone
from uictest.report.content import RunContent
from uictest.report.part_wording import changes_of, slide_speed
from uictest.report.repeat_wording import stops_text
from uictest.report.train_wording import train_text

Stop = evaluation.CaseResult | evaluation.RepeatedStop
FAILING: Final = 1
"""Rank of a column that a missed criterion rests on: it is left out last."""


def measure_columns(
    results: Iterable[evaluation.CaseResult], *, terminal: bool = False, failing: Collection[str] = ()
) -> list[Column[Stop]]:
    """Return the columns of measures; for a terminal with short headings and few digits.

    Those of the names in `failing` are left out last.
    """
    results = list(results)
    speed = slide_speed(results)
    columns: list[Column[Stop]] = []
    for each in (*measures.STOP_COLUMNS.values(), *measures.WHEELSET_COLUMNS.values()):
        if (shown := each.overview) is not None and not _repeats(each.name, shown.unlike, results):
            heading, digits = shown.heading, shown.digits
            if terminal:
                heading = shown.short or heading
                digits = digits if shown.few_digits is None else shown.few_digits
            text = partial(_text, each, digits, "-" if terminal else "–")  # noqa: RUF001 - a dash on paper
            rank = FAILING if each.name in failing else shown.rank
            columns.append(Column(heading=heading.format(speed), text=text, rank=rank, right=True))
    return columns


def _repeats(name: str, other: str, results: Iterable[Stop]) -> bool:
    """Return whether a column of stops says the same as another one in every case."""
    measures_of = [result.measures for result in results if other and result.measures]
    return bool(other) and all(repr(each.get(name)) == repr(each.get(other)) for each in measures_of)


def _text(column: measures.Column, digits: int, missing: str, stop: Stop) -> str:
    """Return a measure of a stop, or the largest of its wheelsets."""
    if isinstance(column, measures.StopColumn):
        value = (stop.measures or {}).get(column.name)
    else:
        value = max((wheelset[column.name] for wheelset in stop.wheelsets), default=None)
    return missing if value is None or math.isnan(value) else column.text(value, digits)


def _words(status: str) -> str:
    return status.replace("_", " ")


def cases_table(content: RunContent) -> Table:
    """Return the cases of a run, those not as expected first, and why they are not."""

    def outcome(result: evaluation.CaseResult) -> str:
        return f"{result.outcome}{' (recorded stop)' if content.subject(result.id).recorded else ''}"

    def why(result: evaluation.CaseResult) -> str:
        return "" if content.passes(result) else "; ".join(content.explanation(result))

    columns: list[Column[Any]] = [
        Column(heading="verdict", text=content.word, tone=lambda result: tone(content.word(result))),
        Column(heading="case", text=lambda result: result.id, literal=True),
        Column(heading="outcome", text=outcome),
        Column(heading="test validity", text=lambda result: _words(result.test_validity)),
        Column(heading="requirements", text=lambda result: _words(result.requirement_status)),
        Column(heading="stops", text=stops_text),
        *measure_columns(content.results),
        Column(heading="train", text=train_text),
        Column(heading="changed parameters", text=lambda result: "; ".join(changes_of(result))),
        Column(heading="why", text=why),
    ]
    return Table(columns, content.ranked, more="more cases are in `summary.csv` and `results.json`.")
