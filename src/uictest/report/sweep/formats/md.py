"""The result of a sweep in Markdown, as a job's summary on GitHub shows it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import partial

from uictest.report.github import LIMIT, append_to_step_summary
from uictest.report.sweep.folder import SweepContent, one_file
from uictest.report.sweep.map_text import folded, is_large, short_label
from uictest.report.sweep.result import (
    Frontier,
    MeasureHistogram,
    OutcomeCount,
    SobolIndex,
    SobolSensitivity,
    SweepMap,
    SweepResult,
)
from uictest.report.sweep.tail_tables import TailTable, tables_left_out, tail_tables
from uictest.report.sweep.wording import (
    NotableCase,
    bar,
    circumstances_words,
    flip_words,
    notable_cases,
    share_words,
    sweep_tally,
    swept_words,
)
from uictest.report.text_tables import MarkdownTable, code, number_cell, prose, row

_MOST_ROWS = 30
"""Values of a parameter, or lines of the frontier, that a reader is shown here."""

_RESERVE = 200  # bytes kept for the line that counts the tables left out

Finding = tuple[str, MarkdownTable]
"""A heading, with more lines below it where there is more to say, and a table; Markdown already."""


def sweep_markdown(content: SweepContent, limit: int = LIMIT) -> str:
    """Return the summary: counts, the map of verdicts, the worst cases, and what they depend on.

    What would go beyond `limit` bytes is left out, and lines say how much that is.
    """
    text = f"## uictest sweep: {sweep_tally(content.result)}\n"
    left_out = 0
    for heading, table in _findings(content.result):
        title = f"\n### {heading}\n\n"
        shown = table.within(limit - len(f"{text}{title}".encode()) - _RESERVE)
        text += f"{title}{shown}" if shown else ""
        left_out += not shown
    return text + (f"\n{left_out} more tables are in `index.html` and `sweep.json`.\n" if left_out else "")


def append_sweep_step_summary(content: SweepContent) -> None:
    """Append the summary to the file that GitHub Actions names, where it does. Raises OSError."""
    append_to_step_summary(partial(sweep_markdown, content))


def _findings(result: SweepResult) -> Iterator[Finding]:
    yield prose(result.title or result.name), _swept(result.rates)
    yield from (_map(sweep_map) for sweep_map in result.maps if sweep_map.shows_met)
    if cases := notable_cases(result):
        yield "Cases most worth looking at", _notable(cases)
    yield "Cases met by value of each parameter", _rates(result.rates)
    if result.frontier is not None:
        yield _frontier(result.frontier)
    if result.sensitivities:
        yield "Share of the variance that each parameter explains", _sensitivities(result.sensitivities)
    yield from map(_tail, tail_tables(result))
    if result.distributions:
        yield "Measures", _measures(result.distributions)
    if notes := (*tables_left_out(result), *result.notes):
        yield "Notes", MarkdownTable(("note",), "l", [row([prose(note)]) for note in notes])


def _tail(table: TailTable) -> Finding:
    heading = f"{prose(f'{table.title[0].upper()}{table.title[1:]}')}\n\n{prose(table.basis)}"
    rows = [row(map(prose, texts)) for texts in table.rows]
    alignment = "l" + "r" * (len(table.columns) - 1)
    return heading, MarkdownTable(table.columns, alignment, rows, f"more levels are in `{table.file}`.")


def _swept(rates: Mapping[str, Sequence[OutcomeCount]]) -> MarkdownTable:
    rows = [
        row([code(key), prose(swept_words([count.value for count in counts]))])
        for key, counts in rates.items()
    ]
    return MarkdownTable(("parameter", "values"), "ll", rows, "more parameters were swept.")


def _map(sweep_map: SweepMap) -> Finding:
    down, across = (code(axis.parameter) for axis in (sweep_map.rows, sweep_map.columns))
    heading = "Share of cases met, %"
    if is_large(sweep_map):
        heading += "\n\nNeighbouring values are shown together; `map-met.csv` has each of them."
    shown = folded(sweep_map)
    lines = zip(shown.rows, shown.met, shown.cases, strict=True)
    rows = [row([prose(short_label(values)), *map(_share, met, cases)]) for values, met, cases in lines]
    columns = (f"{down} ↓ {across} →", *(prose(short_label(values)) for values in shown.columns))
    alignment = "l" + "r" * len(shown.columns)
    return heading, MarkdownTable(columns, alignment, rows, "more rows are in `map-met.csv`.")


def _share(met: int, cases: int) -> str:
    words = share_words(met, cases)
    return words if met == cases else f"**{words}**"


def _notable(cases: Sequence[NotableCase]) -> MarkdownTable:
    columns = ("verdict", "case", "outcome", "distance, m", "margin, %", "criterion", "why")
    return MarkdownTable(columns, "lllrrll", list(map(_case, cases)), "more cases are in `index.html`.")


def _case(case: NotableCase) -> str:
    word = case.word if case.met else f"**{case.word}**"
    return row(
        [
            word,
            code(case.id),
            prose(case.outcome),
            number_cell(case.distance, ".1f"),
            number_cell(case.margin, ".1f"),
            prose(case.criterion),
            prose(case.why),
        ]
    )


def _rates(rates: Mapping[str, Sequence[OutcomeCount]]) -> MarkdownTable:
    rows = [line for key, counts in rates.items() for line in _rates_of(key, counts)]
    columns = ("parameter", "value", "cases", "met", "met, %", "")
    return MarkdownTable(columns, "llrrrl", rows, "more lines are in `rates.csv`.")


def _rates_of(key: str, counts: Sequence[OutcomeCount]) -> Iterator[str]:
    if len(counts) > _MOST_ROWS:
        yield row([code(key), f"{len(counts)} values, see `rates.csv`", "", "", "", ""])
        return
    for place, count in enumerate(counts):
        met, cases = count.met, count.cases
        # Under its name stands what belongs to a parameter, as in a printed table.
        name = "" if place else code(key)
        label = prose(count.value.label)
        yield row([name, label, str(cases), str(met), share_words(met, cases), bar(met, cases)])


def _frontier(frontier: Frontier) -> Finding:
    rows = [
        row(
            [
                prose(circumstances_words(scan.circumstances)),
                prose("; ".join(map(flip_words, scan.flips))),
                prose(scan.note),
            ]
        )
        for scan in frontier.scans
    ]
    table = MarkdownTable(
        ("at", "verdict", "note"), "lll", rows, "more lines are in `frontier.csv`.", _MOST_ROWS
    )
    return f"Frontier along {code(frontier.parameter)}", table


def _sensitivities(sensitivities: Sequence[SobolSensitivity]) -> MarkdownTable:
    columns = ("measure", "parameter", "at", "alone", "95 %", "with the others", "95 %")
    rows = [
        row(
            [
                code(each.measure),
                code(each.key),
                prose(circumstances_words(each.circumstances)),
                *_index(each.first),
                *_index(each.total),
            ]
        )
        for each in sensitivities
    ]
    return MarkdownTable(columns, "lllrlrl", rows, "more lines are in `sensitivity.csv`.")


def _index(index: SobolIndex) -> tuple[str, str]:
    value, low, high = (number_cell(number, ".3f") for number in (index.value, index.low, index.high))
    return value, f"{low} .. {high}"


def _measures(histograms: Sequence[MeasureHistogram]) -> MarkdownTable:
    rows = [
        row(
            [
                code(each.measure),
                prose(each.unit),
                str(each.cases),
                *(number_cell(number, ".4g") for number in (each.minimum, each.mean, each.maximum)),
            ]
        )
        for each in histograms
    ]
    columns = ("measure", "unit", "cases", "minimum", "mean", "maximum")
    return MarkdownTable(columns, "llrrrr", rows, "more measures are in `sweep.json`.")


def _text(content: SweepContent) -> bytes:
    return sweep_markdown(content).encode()


FORMAT = one_file("summary.md", _text)
