"""The cases of a run as a table: one list of columns for every format that people read."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable
from functools import partial
from typing import Any, Final

from uictest.core import measures
from uictest.core.document import Column, Table
from uictest.judging import evaluation
from uictest.report.content import RunContent
from uictest.report.part_wording import changes_of, slide_speed
from uictest.report.repeat_wording import stops_text
from uictest.report.train_wording import train_text
from uictest.report.verdict_sentences import tone

Stop = evaluation.CaseResult | evaluation.RepeatedStop
FAILING: Final = 1
"""Rank of a column that a missed criterion rests on: it is left out last."""


def measure_columns(
    results: Iterable[evaluation.CaseResult], *, terminal: bool = False, failing: Collection[str] = ()
) -> list[Column[Stop]]:
    """Return the columns of measures; for a terminal with short headings and few digits.

    Those of the names in `failing` are left out last.
    """
    speed = slide_speed(results)
    columns: list[Column[Stop]] = []
    for each in (*measures.STOP_COLUMNS.values(), *measures.WHEELSET_COLUMNS.values()):
        if (shown := each.overview) is not None:
            heading, digits = shown.heading, shown.digits
            if terminal:
                heading = shown.short or heading
                digits = digits if shown.few_digits is None else shown.few_digits
            text = partial(_text, each, digits, "-" if terminal else "–")  # noqa: RUF001 - a dash on paper
            rank = FAILING if each.name in failing else shown.rank
            columns.append(Column(heading=heading.format(speed), text=text, rank=rank, right=True))
    return columns


def _text(column: measures.Column, digits: int, missing: str, stop: Stop) -> str:
    """Return a measure of a stop, or the largest of its wheelsets."""
    if isinstance(column, measures.StopColumn):
        value = (stop.measures or {}).get(column.name)
    else:
        value = max((wheelset[column.name] for wheelset in stop.wheelsets), default=None)
    return missing if value is None or math.isnan(value) else column.text(value, digits)


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
        Column(heading="stops", text=stops_text),
        *measure_columns(content.results),
        Column(heading="train", text=train_text),
        Column(heading="changed parameters", text=lambda result: "; ".join(changes_of(result))),
        Column(heading="why", text=why),
    ]
    return Table(columns, content.ranked, more="more cases are in `summary.csv` and `results.json`.")
