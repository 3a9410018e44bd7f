"""The verdicts of a run as a small table for a notebook."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape
from typing import Final

from uictest import report
from uictest.judging import evaluation, series

_MOST_ROWS: Final = 50
_COLOURS: Final = {"good": "#1a7f37", "bad": "#cf222e", "odd": "#8250df"}
_MEASURES: Final = {"braking_distance_m": "distance, m", "braking_time_s": "time, s"}
"""Column of measures -> heading."""


def verdict_html(content: report.RunContent) -> str:
    """Return the counts of a run and one row for each case, those not as expected first. Text is escaped."""
    ranked = sorted(content.results, key=lambda result: result.met)
    rows = [*(_series_row(each) for each in content.series), *map(_case_row, ranked[:_MOST_ROWS])]
    more = len(ranked) - _MOST_ROWS
    note = f"<p>and {report.counted(more, 'more case')}: <code>frame()</code> has all</p>" if more > 0 else ""
    heads = "".join(f"<th>{escape(head)}</th>" for head in ("case", "verdict", *_MEASURES.values(), "reason"))
    table = f"<table><thead><tr>{heads}</tr></thead><tbody>{''.join(rows)}</tbody></table>"
    return f"<p>{escape(content.tally)}</p>{table if rows else ''}{note}"


def _case_row(result: evaluation.CaseResult) -> str:
    numbers = [report.number((result.measures or {}).get(name)) for name in _MEASURES]
    return _row(result.id, report.result_word(result), numbers, "" if result.met else result.reason)


def _series_row(result: series.SeriesResult) -> str:
    word = report.series_word(result)
    return _row(result.id, word, ["-"] * len(_MEASURES), "" if result.met else result.reason)


def _row(name: str, word: str, numbers: Sequence[str], reason: str) -> str:
    coloured = f'<td style="color:{_COLOURS[report.tone(word)]}">{escape(word)}</td>'
    return f"<tr>{_cells([name])}{coloured}{_cells(numbers)}{_cells([reason])}</tr>"


def _cells(texts: Iterable[str]) -> str:
    return "".join(f"<td>{escape(report.printable(text))}</td>" for text in texts)
