"""The findings of a sweep in Markdown, as a job's summary on GitHub shows them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

from uictest.report.github import LIMIT, append_to_step_summary
from uictest.report.markdown_table import MarkdownTable, code, figure, prose, row
from uictest.report.sweep.bundles import bundled, is_large
from uictest.report.sweep.notable import NotableCase, notable_cases
from uictest.report.sweep.wording import (
    bar,
    circumstances_words,
    flip_words,
    share_words,
    sweep_tally,
    swept_words,
)

if TYPE_CHECKING:
    from uictest.report.sweep.content import SweepContent

_MOST_ROWS = 30
"""Values of a parameter, or lines of the frontier, that a reader is shown here."""

_RESERVE = 200  # bytes kept for the line that counts the tables left out

Finding = tuple[str, MarkdownTable]
"""A heading, with more lines below it where there is more to say, and a table; Markdown already."""


def sweep_markdown(content: SweepContent, limit: int = LIMIT) -> str:
    """Return the summary: counts, the map of verdicts, the worst cases, and what they depend on.

    What would go beyond `limit` bytes is left out, and lines say how much that is.
    """
    text = f"## uictest sweep: {sweep_tally(content.document)}\n"
    left_out = 0
    for heading, table in _findings(content):
        title = f"\n### {heading}\n\n"
        shown = table.within(limit - len(f"{text}{title}".encode()) - _RESERVE)
        text += f"{title}{shown}" if shown else ""
        left_out += not shown
    return text + (f"\n{left_out} more tables are in `index.html` and `sweep.json`.\n" if left_out else "")


def append_sweep_step_summary(content: SweepContent) -> None:
    """Append the summary to the file that GitHub Actions names, where it does. Raises OSError."""
    append_to_step_summary(partial(sweep_markdown, content))


def _findings(content: SweepContent) -> Iterator[Finding]:
    document = content.document
    yield prose(document["title"] or document["name"]), _swept(document["rates"])
    yield from (_map(found) for found in document["maps"] if found["measure"] == "met")
    if cases := notable_cases(content):
        yield "Cases most worth looking at", _notable(cases)
    yield "Cases met by value of each parameter", _rates(document["rates"])
    if document["frontier"]:
        yield _frontier(document["frontier"])
    if document["sensitivities"]:
        yield "Share of the variance that each parameter explains", _sensitivities(document["sensitivities"])
    if document["distributions"]:
        yield "Figures", _figures(document["distributions"])
    if document["notes"]:
        yield "Notes", MarkdownTable(("note",), "l", [row([prose(note)]) for note in document["notes"]])


def _swept(rates: Mapping[str, Any]) -> MarkdownTable:
    rows = [row([code(key), prose(swept_words([each["value"] for each in rates[key]]))]) for key in rates]
    return MarkdownTable(("parameter", "values"), "ll", rows, "more parameters were swept.")


def _map(found: Mapping[str, Any]) -> Finding:
    down, across = (code(found[axis]["parameter"]) for axis in ("rows", "columns"))
    heading = "Share of cases met, %"
    if is_large(found):
        heading += "\n\nNeighbouring values are shown together; `map-met.csv` has each of them."
    shown = bundled(found)
    labels = shown["columns"]["values"]
    lines = zip(shown["rows"]["values"], shown["met"], shown["cases"], strict=True)
    rows = [row([prose(label), *map(_share, met, cases)]) for label, met, cases in lines]
    columns = (f"{down} ↓ {across} →", *map(prose, labels))
    return heading, MarkdownTable(columns, "l" + "r" * len(labels), rows, "more rows are in `map-met.csv`.")


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
            figure(case.distance, ".1f"),
            figure(case.margin, ".1f"),
            prose(case.criterion),
            prose(case.why),
        ]
    )


def _rates(rates: Mapping[str, Any]) -> MarkdownTable:
    rows = [line for key, counts in rates.items() for line in _rates_of(key, counts)]
    columns = ("parameter", "value", "cases", "met", "met, %", "")
    return MarkdownTable(columns, "llrrrl", rows, "more lines are in `rates.csv`.")


def _rates_of(key: str, counts: Sequence[Mapping[str, Any]]) -> Iterator[str]:
    if len(counts) > _MOST_ROWS:
        yield row([code(key), f"{len(counts)} values, see `rates.csv`", "", "", "", ""])
        return
    for place, each in enumerate(counts):
        met, cases = each["met"], each["cases"]
        # Under its name stands what belongs to a parameter, as in a printed table.
        name = "" if place else code(key)
        yield row(
            [name, prose(each["value"]), str(cases), str(met), share_words(met, cases), bar(met, cases)]
        )


def _frontier(found: Mapping[str, Any]) -> Finding:
    rows = [
        row(
            [
                prose(circumstances_words(each["circumstances"])),
                prose("; ".join(map(flip_words, each["flips"]))),
                prose(each["note"]),
            ]
        )
        for each in found["stretches"]
    ]
    table = MarkdownTable(
        ("at", "verdict", "note"), "lll", rows, "more lines are in `frontier.csv`.", _MOST_ROWS
    )
    return f"Frontier along {code(found['parameter'])}", table


def _sensitivities(found: Sequence[Mapping[str, Any]]) -> MarkdownTable:
    columns = ("figure", "parameter", "at", "alone", "95 %", "with the others", "95 %")
    rows = [
        row(
            [
                code(each["measure"]),
                code(each["key"]),
                prose(circumstances_words(each["circumstances"])),
                *_index(each["first"]),
                *_index(each["total"]),
            ]
        )
        for each in found
    ]
    return MarkdownTable(columns, "lllrlrl", rows, "more lines are in `sensitivity.csv`.")


def _index(index: Mapping[str, float | None]) -> tuple[str, str]:
    value, low, high = (figure(index[name], ".3f") for name in ("value", "low", "high"))
    return value, f"{low} .. {high}"


def _figures(found: Sequence[Mapping[str, Any]]) -> MarkdownTable:
    ends = ("minimum", "mean", "maximum")
    rows = [
        row(
            [
                code(each["measure"]),
                prose(each["unit"]),
                str(each["cases"]),
                *(figure(each[end], ".4g") for end in ends),
            ]
        )
        for each in found
    ]
    return MarkdownTable(
        ("figure", "unit", "cases", *ends), "llrrrr", rows, "more figures are in `sweep.json`."
    )
