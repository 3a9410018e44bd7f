"""Series on a terminal: side by side, as lines made for grep, and as annotations."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from uictest.core.series_measures import SERIES_MEASURES, SeriesValue
from uictest.judging.series import SeriesResult, SeriesVerdict
from uictest.report.escaping import printable
from uictest.report.github import annotation
from uictest.report.series.wording import (
    confidence_words,
    count_sentences,
    interval,
    not_counted_sentences,
    of_dry_stop,
    series_explanation,
    series_verdict_sentence,
    series_word,
    short,
    unsettled_of_series,
)
from uictest.report.terminal.fitted_columns import TableColumn, aligned, columns_not_shown, fitted
from uictest.report.wording import limits, line_word, number, quantity

_REMARKS = {"fail": "fail", "inconclusive": "inconclusive", "not_applicable": "not applicable"}
_NOT_CERTAIN = "not certain"


def comparison_columns(results: Sequence[SeriesResult]) -> list[str]:
    """Return the headings of the comparison: a column for each criterion of any series, with its unit."""
    return ["series", "verdict", "wet stops", *(_heading(each) for each in _criteria_rows(results).values())]


def comparison_rows(results: Sequence[SeriesResult]) -> Iterator[list[str]]:
    """Yield the cells of every series: how many wet stops count, then what each criterion came to."""
    for result in results:
        by_id = {each.verdict.id: each for each in result.criteria}
        cells = [_cell(by_id[name]) if name in by_id else "-" for name in _criteria_rows(results)]
        yield [
            result.id,
            series_word(result),
            f"{result.wet_stops.counted} of {result.wet_stops.run}",
            *cells,
        ]


def value_with_interval(value: SeriesValue) -> str:
    """Return a value with its interval in parentheses, `-` where there is none."""
    if value.estimate is None:
        return "-"
    shown = interval(value.estimate)
    return f"{short(value.estimate.value)} ({shown})" if shown else short(value.estimate.value)


def _criteria_rows(results: Sequence[SeriesResult]) -> dict[str, SeriesVerdict]:
    """Return the first verdict of every criterion by its id."""
    found: dict[str, SeriesVerdict] = {}
    for result in results:
        for each in result.criteria:
            found.setdefault(each.verdict.id, each)
    return found


def _heading(each: SeriesVerdict) -> str:
    unit = "" if each.verdict.unit == "1" else each.verdict.unit
    return f"{each.verdict.id}, {unit}{of_dry_stop(each)}" if unit else each.verdict.id


def _cell(each: SeriesVerdict) -> str:
    known = short(each.verdict.value)
    value = known if each.estimate is None else value_with_interval(SeriesValue(each.estimate))
    remark = _REMARKS.get(each.verdict.status, "")
    return ", ".join(
        filter(None, (f"{value} {remark}".strip(), _NOT_CERTAIN if each.confident is False else ""))
    )


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


SHOWN_MEASURES = ("k_wet", "stopping_distance_extension", "passing_share")


def series_line(result: SeriesResult) -> str:
    """Return the line of a series: word, id, outcome, and its measures as `key=value`."""
    words = [line_word(series_word(result)), printable(result.id)]
    words += [f"outcome={result.outcome}", f"expect={result.expect}"]
    for name in SHOWN_MEASURES:
        of_rails = {f"{name}[{each.place.replace(' ', '')}]": each for each in result.speeds if each.rail}
        pooled = SERIES_MEASURES[name].pooled or not of_rails
        for key, measured in ({name: result} if pooled else of_rails).items():
            estimate = measured.measures[name].estimate
            words.append(f"{key}={number(None if estimate is None else estimate.value)}")
    if not result.met:
        reasons = [result.reason] if result.reason else unsettled_of_series(result)
        words.append(f"reason={printable('; '.join(reasons))}")
    return " ".join(words)


def series_lines(result: SeriesResult) -> Iterator[str]:
    """Yield what stands below the line of a series: its criteria, the stops that count and that do not."""
    for each in result.criteria:
        yield f"criterion {printable(result.id)} {series_verdict_sentence(each, result.confidence)}"
    for sentence in (*count_sentences(result), *not_counted_sentences(result)):
        yield f"stops {printable(result.id)} {sentence}"


def series_annotations(result: SeriesResult) -> Iterator[str]:
    """Yield an `::error` command for a series that misses its expectation."""
    if not result.met:
        title = f"{series_word(result)} {result.id}"
        yield annotation(result.file, title, "\n".join(series_explanation(result)))
