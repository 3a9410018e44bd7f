"""The result of a sweep as tables: rates, maps, trends, sensitivities, frontier."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, Final, NamedTuple, Protocol

from uictest.core.document import (
    Blocks,
    Cell,
    Column,
    Document,
    Lines,
    Section,
    Table,
    keyed_columns,
    table_of,
)
from uictest.judging import evaluation
from uictest.report import page
from uictest.report.formats import Publication
from uictest.report.formats.csv import ParquetRows
from uictest.report.formats.text import section_lines, titled_lines, wrapped_sentence
from uictest.report.robustness import firmness_sentences, firmness_table, strongest_numbers_table
from uictest.report.sweep import SUMMARY, every_case
from uictest.report.sweep.result import (
    Circumstances,
    Flip,
    Frontier,
    MeasureRange,
    OutcomeCount,
    SobolSensitivity,
    SweepContent,
    SweepMap,
    SweepResult,
)
from uictest.report.sweep.sweep_maps import folded, is_large, map_lines, short_label
from uictest.report.sweep.sweep_sentences import (
    OUTCOME_HEADINGS,
    bar,
    circumstances_words,
    flip_words,
    missed_blocks,
    share_words,
    sweep_suite,
    sweep_tally,
    swept_words,
    where_met,
)
from uictest.report.sweep.values import SweptValue
from uictest.report.words import printable

_MOST_ROWS: Final = 30
"""Values of a parameter, or lines of the frontier, that a reader is shown; chosen."""


def sweep_tables(result: SweepResult) -> list[Table]:
    """Return the tables of a sweep besides its summary."""
    frontier = [frontier_table(result.frontier)] if result.frontier else []
    optional = [sensitivity_table(result), *frontier, firmness_table(result.nominal)]
    return [
        rates_table(result),
        *map(map_table, result.maps),
        trends_table(result),
        *(table for table in optional if table.rows),
    ]


class _Found(Protocol):
    """What was found at some values of the other parameters."""

    @property
    def circumstances(self) -> Circumstances: ...


class _Rate(NamedTuple):
    """The counts of one value of a parameter."""

    parameter: str
    counts: OutcomeCount
    is_first: bool


def rates_table(result: SweepResult) -> Table:
    """Return the table of cases met at each value of each parameter."""
    rows = [
        _Rate(key, count, number == 0)
        for key, counts in result.rates.items()
        for number, count in enumerate(counts)
    ]
    columns: list[Column[_Rate]] = [
        Column(
            key="parameter",
            heading="parameter",
            value=lambda rate: rate.parameter,
            text=lambda rate: rate.parameter if rate.is_first else "",
            literal=True,
        ),
        Column(key="value", heading="value", value=lambda rate: rate.counts.value.label),
        Column(key="cases", heading="cases", value=lambda rate: rate.counts.cases, digits=0),
        Column(key="met", heading="met", value=lambda rate: rate.counts.met, digits=0),
        Column(
            key="share_met",
            heading="met",
            unit="%",
            value=lambda rate: rate.counts.share_met,
            text=lambda rate: share_words(rate.counts.met, rate.counts.cases),
            right=True,
        ),
        *map(_outcome_column, result.outcomes),
        Column(heading=" ", text=lambda rate: bar(rate.counts.met, rate.counts.cases), rank=1),
    ]
    return Table(columns, rows, "Cases met by value of each parameter", name="rates")


def _outcome_column(outcome: str) -> Column[_Rate]:
    """Return the number of cases of an outcome, for people nothing where there are none."""
    return Column(
        key=outcome,
        heading="" if outcome == "pass" else OUTCOME_HEADINGS.get(outcome, outcome),
        value=lambda rate: rate.counts.outcomes.get(outcome),
        text=lambda rate: str(rate.counts.outcomes.get(outcome) or ""),
        right=True,
    )


def short_rates(result: SweepResult) -> Iterator[Table | Lines]:
    """Yield the rates of the parameters with few values, and which have too many for a reader."""
    long = [key for key, counts in result.rates.items() if len(counts) > _MOST_ROWS]
    table = rates_table(result)
    yield replace(table, rows=[row for row in table.rows if row.parameter not in long])
    yield Lines([f"{key}: {len(result.rates[key])} values, see {table.file}" for key in long])


def map_table(sweep_map: SweepMap) -> Table:
    """Return a map for programs: a row per value of the first parameter, a column per value of the other."""
    corner = f"{sweep_map.rows.parameter} \\ {sweep_map.columns.parameter}"
    keys = [corner, *(value.label for value in sweep_map.columns.values)]
    rows: list[dict[str, Cell]] = [
        dict(zip(keys, [value.label, *means], strict=True))
        for value, means in zip(sweep_map.rows.values, sweep_map.means, strict=True)
    ]
    return table_of(f"map-{sweep_map.measure}", rows, keys)


def trends_table(result: SweepResult) -> Table:
    """Return for programs each measure at each value of each parameter."""
    keys = ("parameter", "value", "measure", "unit", "cases", "minimum", "mean", "maximum")
    rows: list[dict[str, Cell]] = []
    for trend in result.trends:
        numbers = zip(trend.values, trend.cases, trend.minimum, trend.mean, trend.maximum, strict=True)
        for value, *cells in numbers:
            about = (trend.parameter, value.label, trend.measure, trend.unit)
            rows.append(dict(zip(keys, (*about, *cells), strict=True)))
    return table_of("trends", rows, keys)


def _circumstances_columns(rows: Sequence[_Found]) -> list[Column[_Found]]:
    """Return the circumstances of rows: for programs a column for each parameter, for people one text."""

    def texts(row: _Found) -> dict[str, Cell]:
        return {key: value.text for key, value in row.circumstances.items()}

    at: Column[_Found] = Column(heading="at", text=lambda row: circumstances_words(row.circumstances))
    return [*keyed_columns(rows[0].circumstances if rows else (), texts), at]


def sensitivity_table(result: SweepResult) -> Table:
    """Return the share of the variance of each measure that each parameter explains."""
    rows = result.sensitivities
    columns: list[Column[SobolSensitivity]] = [
        Column(key="measure", heading="measure", value=lambda row: row.measure, literal=True),
        *_circumstances_columns(rows),
        Column(key="parameter", heading="parameter", value=lambda row: row.key, literal=True),
        Column(key="first", heading="alone", value=lambda row: row.first.value, digits=3),
        Column(key="first_low", value=lambda row: row.first.low),
        Column(key="first_high", value=lambda row: row.first.high),
        Column(heading="95 %", text=lambda row: f"{row.first.low:.3f} .. {row.first.high:.3f}", rank=1),
        Column(key="total", heading="with the others", value=lambda row: row.total.value, digits=3),
        Column(key="total_low", value=lambda row: row.total.low),
        Column(key="total_high", value=lambda row: row.total.high),
        Column(heading="95 %", text=lambda row: f"{row.total.low:.3f} .. {row.total.high:.3f}", rank=1),
    ]
    title = "Share of the variance that each parameter explains"
    return Table(columns, rows, title, name="sensitivity")


class _FrontierRow(NamedTuple):
    """A flip of the verdict, or that there is none, at one combination of the other parameters."""

    circumstances: Circumstances
    flip: Flip | None
    flips: int
    note: str


def frontier_table(frontier: Frontier) -> Table:
    """Return the table of flipping verdicts: a row for each flip, or one with a note where there is none."""
    rows = [
        _FrontierRow(scan.circumstances, flip, len(scan.flips), scan.note)
        for scan in frontier.scans
        for flip in scan.flips or (None,)
    ]
    columns: list[Column[_FrontierRow]] = [
        *_circumstances_columns(rows),
        Column(key="from", value=lambda row: row.flip.low.text if row.flip else None),
        Column(key="to", value=lambda row: row.flip.high.text if row.flip else None),
        Column(key="met_at_from", value=lambda row: row.flip.met_at_low if row.flip else None),
        Column(heading="verdict", text=lambda row: flip_words(row.flip) if row.flip else ""),
        Column(key="flips", value=lambda row: row.flips),
        Column(key="note", heading="note", value=lambda row: row.note),
    ]
    return Table(columns, rows, f"Frontier along {frontier.parameter}", name="frontier")


def _frontier_sections(frontier: Frontier) -> Iterator[Table | Lines]:
    """Yield the rows of flipping verdicts: few rows all, of many the first, those with flips in front."""
    table = frontier_table(frontier)
    rows = list(table.rows)
    if len(rows) > _MOST_ROWS:
        rows = sorted(rows, key=lambda row: row.flip is None)[:_MOST_ROWS]
    yield replace(table, rows=rows)
    if further := len(table.rows) - len(rows):
        yield Lines([f"{further} more in {table.file}"])


_MEASURES: Final[tuple[Column[MeasureRange], ...]] = (
    Column(heading="measure", text=lambda measure: measure.measure, literal=True),
    Column(heading="unit", text=lambda measure: measure.unit),
    Column(heading="cases", value=lambda measure: measure.cases, digits=0),
    Column(heading="minimum", value=lambda measure: measure.minimum, digits="significant"),
    Column(heading="mean", value=lambda measure: measure.mean, digits="significant"),
    Column(heading="maximum", value=lambda measure: measure.maximum, digits="significant"),
)


class _MapRow(NamedTuple):
    """A row of a folded map: its values, and in each column how many cases are met, are tests, there are."""

    values: Sequence[SweptValue]
    met: Sequence[int]
    valid: Sequence[int]
    cases: Sequence[int]

    def text(self, column: int) -> str:
        """Return the share of cases met, or that none of them is a valid test."""
        if self.cases[column] and not self.met[column] and not self.valid[column]:
            return "no test"
        return share_words(self.met[column], self.cases[column])


def _folded_map(sweep_map: SweepMap) -> Table:
    """Return the shares of cases met for people, neighbouring values together where there are many."""
    cells = folded(sweep_map)
    name = f"tables/map-{sweep_map.measure}.csv"
    basis = f"Neighbouring values are shown together; {name} has each of them." if is_large(sweep_map) else ""
    corner = f"{sweep_map.rows.parameter} ↓ {sweep_map.columns.parameter} →"

    def of_column(index: int, values: Sequence[SweptValue]) -> Column[_MapRow]:
        return Column(
            heading=short_label(values),
            text=lambda row: row.text(index),
            right=True,
            tone=lambda row: "good" if row.met[index] == row.cases[index] else "bad",
        )

    columns: list[Column[_MapRow]] = [
        Column(heading=corner, text=lambda row: short_label(row.values)),
        *(of_column(index, values) for index, values in enumerate(cells.columns.groups)),
    ]
    counts = (numbers.tolist() for numbers in (cells.met, cells.valid, cells.cases))
    rows = list(map(_MapRow, cells.rows.groups, *counts))
    return Table(columns, rows, "Share of cases met, %", basis, all_in=name)


_SWEPT: Final[tuple[Column[tuple[str, Sequence[OutcomeCount]]], ...]] = (
    Column(heading="parameter", text=lambda rate: rate[0], literal=True),
    Column(heading="values", text=lambda rate: swept_words([count.value for count in rate[1]])),
)


def _firmness_sections(nominal: Sequence[evaluation.CaseResult]) -> Iterator[Table | Lines]:
    """Yield the tables on how firm the nominal verdicts are, and on the effect of each number on them."""
    sentences = [f"{printable(case.id)}: {line}" for case in nominal for line in firmness_sentences(case)]
    yield Lines(sentences, "Firm or not firm: the nominal case")
    for case in nominal:
        if case.firmness is not None:
            yield strongest_numbers_table(case.firmness, "" if case.train is None else case.train.label)


def numbers_of_sweep(result: SweepResult) -> Iterator[Table | Lines]:
    """Yield the tables of dependence: rates, sensitivities, the frontier, and firmness."""
    yield from short_rates(result)
    yield sensitivity_table(result)
    if result.frontier is not None:
        yield from _frontier_sections(result.frontier)
    if result.nominal:
        yield from _firmness_sections(result.nominal)


def sweep_lines(
    result: SweepResult, manifest: Mapping[str, Any], width: int, *, quiet: bool = False
) -> Iterator[str]:
    """Yield a sweep as text: where it holds, maps, rates and sensitivities, at the end what is missed.

    If `quiet`, only that.
    """
    if not quiet:
        yield from wrapped_sentence(where_met(result), width)
        for sweep_map in result.maps:
            yield ""
            yield from map_lines(sweep_map, width)
        yield ""
        yield from titled_lines(numbers_of_sweep(result), width)
        for note in result.notes:
            yield from wrapped_sentence(f"note: {note}", width)
        yield from [""] if result.notes else []
    blocks = [block for block, _ in missed_blocks(result, manifest)]
    for block in blocks:
        yield from section_lines(Blocks([block]), width)
        yield ""
    if blocks:
        yield f"all of them: {every_case(result.cases)}"


def sweep_summary(result: SweepResult, manifest: Mapping[str, Any]) -> Document:
    """Return the whole result, what decides first."""
    sections: list[Section] = [
        Lines([where_met(result)]),
        Blocks([block for block, _ in missed_blocks(result, manifest)]),
        Table(_SWEPT, list(result.rates.items()), result.title or result.name, all_in="results.json"),
        *(_folded_map(sweep_map) for sweep_map in result.maps if sweep_map.shows_met),
        *numbers_of_sweep(result),
        Table(_MEASURES, result.measures, "Measures", all_in="results.json"),
        Lines(list(result.notes), "Notes"),
    ]
    return Document(f"uictest sweep: {sweep_tally(result)}", sections)


def publication_of_sweep(content: SweepContent) -> Publication:
    """Return a sweep as it is published; its rows are read from its folder when they are needed."""
    result, file = content.result, str(content.manifest.get("file", ""))
    return Publication(
        document=sweep_summary(result, content.manifest),
        tables=[ParquetRows(content.folder / SUMMARY).table("summary"), *sweep_tables(result)],
        page=lambda: page.sweep_page_html(content),
        suites=lambda named: [sweep_suite(result, file, with_properties=named)],
        named_in_tests=bool(result.requirements or result.test_case),
    )
