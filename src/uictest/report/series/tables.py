"""Tables of series for people: what they compare by, and the criteria of each; on a terminal, in Markdown."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Final, NamedTuple

from uictest.core.document import Column, Document, Lines, Table, Tone
from uictest.core.series_measures import SeriesValue
from uictest.judging.series import SeriesResult, SeriesVerdict
from uictest.report.case_words import tone
from uictest.report.counts import counted
from uictest.report.escaping import printable
from uictest.report.series.series_sentences import (
    confidence_words,
    count_sentences,
    interval,
    not_counted_sentences,
    of_dry_stop,
    series_word,
    short,
)
from uictest.report.terminal.table_lines import document_lines, table_lines
from uictest.report.verdict_sentences import limits, margin_text, quantity

_TONES: Final[Mapping[str, Tone]] = {"pass": "good", "fail": "bad", "inconclusive": "odd"}
_REMARKS: Final = {"fail": "fail", "inconclusive": "inconclusive", "not_applicable": "not applicable"}
_MOST: Final = 300
"""Rows and lines that a summary of a run gives to its series."""


def comparison_table(results: Sequence[SeriesResult]) -> Table:
    """Return series side by side: the value of every criterion with its interval, and which are missed."""
    first: dict[str, SeriesVerdict] = {}
    for each in (each for result in results for each in result.criteria):
        first.setdefault(each.verdict.id, each)
    columns: list[Column[SeriesResult]] = [
        Column(heading="series", text=lambda result: result.id, wraps=True, literal=True),
        Column(heading="verdict", text=series_word, rank=1, tone=lambda result: tone(series_word(result))),
        Column(
            heading="wet stops",
            text=lambda result: f"{result.wet_stops.counted} of {result.wet_stops.run}",
            rank=2,
            right=True,
        ),
    ]
    columns += [_criterion_column(each, rank) for rank, each in enumerate(first.values(), start=3)]
    return Table(columns, results, more="every criterion stands below")


def _criterion_column(each: SeriesVerdict, rank: int) -> Column[SeriesResult]:
    name = each.verdict.id
    unit = "" if each.verdict.unit == "1" else f"\n{each.verdict.unit}{of_dry_stop(each)}"

    def text(result: SeriesResult) -> str:
        verdicts = {own.verdict.id: own for own in result.criteria}
        return _value(verdicts[name]) if name in verdicts else "-"

    return Column(heading=f"{name}{unit}", text=text, rank=rank, right=True)


def _value(each: SeriesVerdict) -> str:
    known = short(each.verdict.value)
    value = known if each.estimate is None else value_with_interval(SeriesValue(each.estimate))
    remark = _REMARKS.get(each.verdict.status, "")
    certain = "not certain" if each.confident is False else ""
    return ", ".join(filter(None, (f"{value} {remark}".strip(), certain)))


def value_with_interval(value: SeriesValue) -> str:
    """Return a value with its interval in parentheses, `-` where there is none."""
    if value.estimate is None:
        return "-"
    shown = interval(value.estimate)
    return f"{short(value.estimate.value)} ({shown})" if shown else short(value.estimate.value)


class Judged(NamedTuple):
    """A criterion with the series that it judged."""

    result: SeriesResult
    each: SeriesVerdict

    @property
    def status(self) -> str:
        """The verdict in words."""
        certain = ", not certain" if self.each.confident is False else ""
        return f"{self.each.verdict.status.replace('_', ' ')}{certain}"

    @property
    def tone(self) -> Tone | None:
        """The tone of the verdict; one that is not certain has its own."""
        return "odd" if self.each.confident is False else _TONES.get(self.each.verdict.status)


_SERIES: Final[Column[Judged]] = Column(heading="series", text=lambda judged: judged.result.id, literal=True)
CRITERIA: Final[tuple[Column[Judged], ...]] = (
    Column(heading="criterion", text=lambda judged: judged.each.verdict.id, wraps=True, literal=True),
    Column(
        heading="verdict",
        text=lambda judged: judged.status,
        tone=lambda judged: judged.tone,
    ),
    Column(
        heading="value",
        text=lambda judged: quantity(judged.each.verdict.value, judged.each.verdict.unit),
        right=True,
    ),
    Column(
        heading="limit", text=lambda judged: f"{limits(judged.each.verdict, '')}{of_dry_stop(judged.each)}"
    ),
    Column(
        heading="margin",
        text=lambda judged: margin_text(judged.each.verdict),
        right=True,
    ),
    Column(
        heading="confidence",
        text=lambda judged: (
            confidence_words(judged.each, judged.result.confidence) or judged.each.verdict.reason
        ),
        wraps=True,
    ),
)


def judged_criteria(result: SeriesResult) -> list[Judged]:
    """Return the criteria of a series."""
    return [Judged(result, each) for each in result.criteria]


def _counts(result: SeriesResult) -> list[str]:
    return [*count_sentences(result), *not_counted_sentences(result)]


def series_table(results: Sequence[SeriesResult], width: int) -> Iterator[str]:
    """Yield the lines of the comparison and of the criteria of every series."""
    yield from table_lines(comparison_table(results), width)
    for result in results:
        yield ""
        yield f"{series_word(result)} {printable(result.id)}"
        document = Document(result.id, [Table(CRITERIA, judged_criteria(result)), Lines(_counts(result))])
        yield from (f"  {line}" for line in document_lines(document, width - 2))


def series_sections(results: Sequence[SeriesResult]) -> list[Table | Lines]:
    """Return the comparison, the stops that count, and the criteria of every series; nothing without any."""
    if not results:
        return []
    counts = [f"{result.id}: {line}" for result in results for line in _counts(result)]
    if (rest := len(counts) - _MOST) > 0:
        counts[_MOST:] = [f"{counted(rest, 'more line')} in series-stops.csv and results.json"]
    criteria = [judged for result in results for judged in judged_criteria(result)]
    more = "more rows are in `series-criteria.csv` and `results.json`."
    compared = comparison_table(results)._replace(more=more, most=_MOST)
    return [compared, Lines(counts), Table((_SERIES, *CRITERIA), criteria, more=more, most=_MOST)]
