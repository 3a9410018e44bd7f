"""The result of a sweep as tables for people: rates, sensitivities, frontier, notable cases."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final, NamedTuple

from uictest.core.document import Column, Document, Lines, Table
from uictest.judging import evaluation
from uictest.report.case_words import tone
from uictest.report.escaping import printable
from uictest.report.firmness_sentences import firmness_sentences, firmness_table
from uictest.report.sweep.map_text import folded, is_large, short_label
from uictest.report.sweep.result import (
    Frontier,
    FrontierScan,
    MeasureRange,
    OutcomeCount,
    SobolSensitivity,
    SweepMap,
    SweepResult,
)
from uictest.report.sweep.sweep_sentences import (
    NotableCase,
    bar,
    circumstances_words,
    flip_words,
    notable_cases,
    share_words,
    sweep_tally,
    swept_words,
)
from uictest.report.sweep.values import SweptValue
from uictest.report.text_tables import number_cell

_MOST_ROWS: Final = 30
"""Values of a parameter, or lines of the frontier, that a reader is shown."""


class _Rate(NamedTuple):
    """A line of the counts; a parameter stands beside the first of its values."""

    parameter: str
    value: str
    counted: OutcomeCount | None

    @property
    def met(self) -> tuple[int, int]:
        return (0, 0) if self.counted is None else (self.counted.met, self.counted.cases)

    def number(self, value: int) -> str:
        return "" if self.counted is None else str(value)


_RATES: Final[tuple[Column[_Rate], ...]] = (
    Column(heading="parameter", text=lambda rate: rate.parameter, literal=True),
    Column(heading="value", text=lambda rate: rate.value),
    Column(heading="cases", text=lambda rate: rate.number(rate.met[1]), right=True),
    Column(heading="met", text=lambda rate: rate.number(rate.met[0]), right=True),
    Column(heading="met, %", text=lambda rate: share_words(*rate.met) if rate.counted else "", right=True),
    Column(
        heading="not judged",
        text=lambda rate: str(rate.counted.outcomes.get("skipped") or "") if rate.counted else "",
        right=True,
    ),
    Column(heading=" ", text=lambda rate: bar(*rate.met), rank=1),
)


def rates_table(result: SweepResult) -> Table:
    """Return how many cases are met at each value of each parameter."""
    rows = [row for key, counts in result.rates.items() for row in _rates(key, counts)]
    title = "Cases met by value of each parameter"
    return Table(_RATES, rows, title, more="more lines are in `rates.csv`.")


def _rates(key: str, counts: Sequence[OutcomeCount]) -> Iterator[_Rate]:
    if len(counts) > _MOST_ROWS:
        yield _Rate(key, f"{len(counts)} values, see rates.csv", None)
        return
    for place, count in enumerate(counts):
        yield _Rate("" if place else key, count.value.label, count)


_SENSITIVITIES: Final[tuple[Column[SobolSensitivity], ...]] = (
    Column(heading="measure", text=lambda each: each.measure, literal=True),
    Column(heading="parameter", text=lambda each: each.key, literal=True),
    Column(heading="at", text=lambda each: circumstances_words(each.circumstances)),
    Column(heading="alone", text=lambda each: f"{each.first.value:.3f}", right=True),
    Column(heading="95 %", text=lambda each: f"{each.first.low:.3f} .. {each.first.high:.3f}", rank=1),
    Column(heading="with the others", text=lambda each: f"{each.total.value:.3f}", right=True),
    Column(heading="95 %", text=lambda each: f"{each.total.low:.3f} .. {each.total.high:.3f}", rank=1),
)


def sensitivity_table(result: SweepResult) -> Table:
    """Return the share of the variance of each measure that each parameter explains."""
    title = "Share of the variance that each parameter explains"
    return Table(_SENSITIVITIES, result.sensitivities, title, more="more lines are in `sensitivity.csv`.")


_FRONTIER: Final[tuple[Column[FrontierScan], ...]] = (
    Column(heading="at", text=lambda scan: circumstances_words(scan.circumstances)),
    Column(heading="verdict", text=lambda scan: "; ".join(map(flip_words, scan.flips))),
    Column(heading="note", text=lambda scan: scan.note),
)


def frontier_table(frontier: Frontier) -> Table:
    """Return where verdicts flip."""
    title = f"Frontier along {frontier.parameter}"
    return Table(_FRONTIER, frontier.scans, title, more="more lines are in `frontier.csv`.")


def _frontier_sections(frontier: Frontier) -> Iterator[Table | Lines]:
    """Yield where verdicts flip: few scans all, of many the first, those with flips before the others."""
    table = frontier_table(frontier)
    if len(table.rows) > _MOST_ROWS:
        table = table._replace(rows=sorted(table.rows, key=lambda each: not each.flips)[:_MOST_ROWS])
    yield table
    if further := len(frontier.scans) - len(table.rows):
        yield Lines([f"{further} more in frontier.csv"])


_MEASURES: Final[tuple[Column[MeasureRange], ...]] = (
    Column(heading="measure", text=lambda each: each.measure, literal=True),
    Column(heading="unit", text=lambda each: each.unit),
    Column(heading="cases", text=lambda each: str(each.cases), right=True),
    Column(heading="minimum", text=lambda each: number_cell(each.minimum, ".4g"), right=True),
    Column(heading="mean", text=lambda each: number_cell(each.mean, ".4g"), right=True),
    Column(heading="maximum", text=lambda each: number_cell(each.maximum, ".4g"), right=True),
)
_NOTABLE: Final[tuple[Column[NotableCase], ...]] = (
    Column(heading="verdict", text=lambda case: case.word, tone=lambda case: tone(case.word)),
    Column(heading="case", text=lambda case: case.id, literal=True),
    Column(heading="outcome", text=lambda case: case.outcome),
    Column(heading="distance\nm", text=lambda case: number_cell(case.distance, ".1f"), right=True),
    Column(heading="margin\n%", text=lambda case: number_cell(case.margin, ".1f"), right=True),
    Column(heading="criterion", text=lambda case: case.criterion),
    Column(heading="why", text=lambda case: case.why, wraps=True),
)


def notable_table(result: SweepResult) -> Table:
    """Return the cases most worth looking at, missed ones first."""
    cases = notable_cases(result)
    return Table(_NOTABLE, cases, "Cases most worth looking at", more="more cases are in `index.html`.")


class _MapRow(NamedTuple):
    """A row of a folded map: its values, and how many cases are met, and there are, in each column."""

    values: Sequence[SweptValue]
    met: Sequence[int]
    cases: Sequence[int]


def _map_table(sweep_map: SweepMap) -> Table:
    shown = folded(sweep_map)
    basis = ""
    if is_large(sweep_map):
        basis = "Neighbouring values are shown together; map-met.csv has each of them."
    corner = f"{sweep_map.rows.parameter} ↓ {sweep_map.columns.parameter} →"
    columns: list[Column[_MapRow]] = [Column(heading=corner, text=lambda row: short_label(row.values))]
    columns += [_map_column(place, short_label(values)) for place, values in enumerate(shown.columns)]
    rows = list(map(_MapRow, shown.rows, shown.met, shown.cases))
    return Table(columns, rows, "Share of cases met, %", basis, "more rows are in `map-met.csv`.")


def _map_column(place: int, label: str) -> Column[_MapRow]:
    return Column(
        heading=label,
        text=lambda row: share_words(row.met[place], row.cases[place]),
        right=True,
        tone=lambda row: "good" if row.met[place] == row.cases[place] else "bad",
    )


class _Swept(NamedTuple):
    parameter: str
    values: str


_SWEPT: Final[tuple[Column[_Swept], ...]] = (
    Column(heading="parameter", text=lambda row: row.parameter, literal=True),
    Column(heading="values", text=lambda row: row.values),
)


def _firmness_sections(nominal: Sequence[evaluation.CaseResult]) -> Iterator[Table | Lines]:
    """Yield how firm the verdicts of the nominal cases are, and the numbers by what they do to them."""
    title = "Firm or not firm: the nominal case"
    yield Lines(
        [f"{printable(each.id)}: {line}" for each in nominal for line in firmness_sentences(each)], title
    )
    for each in nominal:
        if each.firmness is not None:
            yield firmness_table(each.firmness, "" if each.train is None else each.train.label)


def numbers_of_sweep(result: SweepResult) -> Iterator[Table | Lines]:
    """Yield what depends on what: rates, sensitivities, the frontier, and on numbers nobody knows."""
    yield rates_table(result)
    yield sensitivity_table(result)
    if result.frontier is not None:
        yield from _frontier_sections(result.frontier)
    if result.nominal:
        yield from _firmness_sections(result.nominal)


def sweep_summary(result: SweepResult) -> Document:
    """Return the whole result, what decides first."""
    swept = [
        _Swept(key, swept_words([each.value for each in counts])) for key, counts in result.rates.items()
    ]
    sections = [
        Table(_SWEPT, swept, result.title or result.name, more="more parameters were swept."),
        *(_map_table(each) for each in result.maps if each.shows_met),
        notable_table(result),
        *numbers_of_sweep(result),
        Table(_MEASURES, result.measures, "Measures", more="more measures are in `sweep.json`."),
        Lines(list(result.notes), "Notes"),
    ]
    title = f"uictest sweep: {sweep_tally(result)}"
    return Document(title, sections, more="more tables are in `index.html` and `sweep.json`.")
