"""Series on a terminal: a table that compares them, then the criteria of each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from uictest.judging.series import SeriesResult
from uictest.report.escaping import printable
from uictest.report.series.comparison import comparison_columns, comparison_rows
from uictest.report.series.wording import (
    confidence_words,
    count_sentences,
    not_counted_sentences,
    of_dry_stop,
    series_word,
)
from uictest.report.terminal.fitted_columns import TableColumn, aligned, columns_not_shown, fitted
from uictest.report.wording import limits, quantity

_MORE = "every criterion stands below"


def series_table(results: Sequence[SeriesResult], width: int) -> Iterator[str]:
    """Yield the lines of the comparison and of the criteria of every series."""
    cells = list(zip(*comparison_rows(results), strict=True))
    columns = [
        TableColumn(_two_lines(title), list(map(printable, texts)), rank, right=rank > 1, wraps=rank == 0)
        for rank, (title, texts) in enumerate(zip(comparison_columns(results), cells, strict=True))
    ]
    yield from _table(columns, width)
    for result in results:
        yield ""
        yield f"{series_word(result)} {printable(result.id)}"
        yield from _criteria(result, width)
        yield from (f"  {each}" for each in (*count_sentences(result), *not_counted_sentences(result)))


def _criteria(result: SeriesResult, width: int) -> Iterator[str]:
    rows = [
        (
            each.verdict.id,
            each.verdict.status.replace("_", " "),
            quantity(each.verdict.value, each.verdict.unit),
            f"{limits(each.verdict, '')}{of_dry_stop(each)}",
            quantity(each.verdict.margin, each.verdict.unit),
            confidence_words(each, result.confidence) or each.verdict.reason,
        )
        for each in result.criteria
    ]
    titles = ("criterion", "verdict", "value", "limit", "margin", "confidence")
    cells = list(zip(*rows, strict=True)) or [() for _ in titles]
    columns = [
        TableColumn(title, list(map(printable, texts)), 0, wraps=title in ("criterion", "confidence"))
        for title, texts in zip(titles, cells, strict=True)
    ]
    yield from (f"  {line}" for line in _table(columns, width - 2))


def _table(columns: Sequence[TableColumn], width: int) -> Iterator[str]:
    shown, hidden = fitted(columns, width)
    yield from aligned(shown)
    if hidden:
        yield columns_not_shown(hidden, _MORE)


def _two_lines(title: str) -> str:
    head, comma, unit = title.partition(", ")
    return f"{head}\n{unit}" if comma else title
