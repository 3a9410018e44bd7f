"""Series in Markdown: a table that compares them, and one row per criterion."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import accumulate

from uictest.judging.series import SeriesResult
from uictest.report.series.comparison import comparison_columns, comparison_rows
from uictest.report.series.wording import (
    confidence_words,
    count_sentences,
    not_counted_sentences,
    of_dry_stop,
)
from uictest.report.text_tables import MarkdownTable, code, prose, row
from uictest.report.wording import counted, limits, quantity

_COLUMNS = ("verdict", "series", "criterion", "value", "limit", "margin", "confidence")
_REST = "more rows are in `series-criteria.csv` and `results.json`."


def series_markdown(results: Sequence[SeriesResult], limit: int) -> str:
    """Return the series in at most so many bytes; empty without any."""
    if not results:
        return ""
    headings = comparison_columns(results)
    compared = [row([code(name), *map(prose, cells)]) for name, *cells in comparison_rows(results)]
    comparison = MarkdownTable(headings, "ll" + "r" * (len(headings) - 2), compared, _REST)
    text = f"{comparison.within(limit // 3)}\n"
    text += f"{_within([f'- {prose(line)}' for line in _counts(results)], limit // 3)}\n"
    rows = [row(cells) for result in results for cells in _criteria(result)]
    table = MarkdownTable(_COLUMNS, "lllrlrl", rows, _REST)
    return f"{text}{table.within(limit - len(text.encode()))}\n"


def _within(lines: Sequence[str], limit: int) -> str:
    """Return as many whole lines as fit into so many bytes, and how many do not."""
    sizes = accumulate(len(line.encode()) + 1 for line in lines)
    fitting = sum(size <= limit for size in sizes)
    rest = len(lines) - fitting
    more = [f"- {counted(rest, 'more line')} in `series-stops.csv` and `results.json`"] if rest else []
    return "".join(f"{line}\n" for line in [*lines[:fitting], *more])


def _counts(results: Sequence[SeriesResult]) -> Iterator[str]:
    for result in results:
        for sentence in (*count_sentences(result), *not_counted_sentences(result)):
            yield f"{result.id}: {sentence}"


def _criteria(result: SeriesResult) -> Iterator[list[str]]:
    for each in result.criteria:
        verdict = each.verdict
        status = verdict.status.replace("_", " ")
        yield [
            status if verdict.status in ("pass", "not_applicable") else f"**{status}**",
            code(result.id),
            code(verdict.id),
            prose(f"{quantity(verdict.value, verdict.unit)}{of_dry_stop(each)}"),
            prose(limits(verdict, "")),
            prose(quantity(verdict.margin, verdict.unit)),
            prose(confidence_words(each, result.confidence) or verdict.reason),
        ]
