"""The workbook of a sweep: findings, cases, maps, what the verdicts depend on, worst cases, provenance."""

from __future__ import annotations

import io
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from uictest.report.formats.xlsx import manifest_rows, parameter_rows, result_row
from uictest.report.sheet import Row, open_workbook, styles_of, write_sheet
from uictest.report.sweep.cases import MOST_CASES, left_out, write_cases
from uictest.report.sweep.map_sheet import write_maps
from uictest.report.sweep.notable import notable_cases
from uictest.report.sweep.trends import trend_rows
from uictest.report.sweep.wording import swept_words

if TYPE_CHECKING:
    from uictest.report.sweep.content import SweepContent


def sweep_workbook_bytes(content: SweepContent, most_cases: int = MOST_CASES) -> bytes:
    """Return the workbook of a sweep. A sheet that would have no row is left out.

    Of more than `most_cases` cases the rest is left out; Summary and Cases say so. Raises OSError, and
    ValueError where summary.parquet cannot be read.
    """
    maps = content.document["maps"]
    buffer = io.BytesIO()
    with open_workbook(buffer, streaming=True) as workbook:
        styles = styles_of(workbook)
        write_sheet(workbook.add_worksheet("Summary"), list(_summary(content.document, most_cases)), styles)
        write_cases(workbook.add_worksheet("Cases"), content.folder, styles, most_cases)
        if maps:
            write_maps(workbook.add_worksheet("Maps"), maps, styles)
        for name, rows in _tables(content).items():
            if rows:
                write_sheet(workbook.add_worksheet(name), rows, styles)
    return buffer.getvalue()


def _tables(content: SweepContent) -> dict[str, list[Row]]:
    document = content.document
    return {
        "Rates": list(_rates(document["rates"])),
        "Trends": [row for trend in document["trends"] for row in trend_rows(trend)],
        "Frontier": list(_frontier(document["frontier"] or {"stretches": ()})),
        "Sensitivity": list(_sensitivities(document["sensitivities"])),
        "Worst cases": list(_worst(content)),
        "Parameters": list(_parameters(content)),
        "Provenance": list(manifest_rows(content.manifest)),
    }


def _parameters(content: SweepContent) -> Iterator[Row]:
    """Yield the parameters of the scenario that is varied."""
    varied = content.document.get("varied", ())
    for each in parameter_rows([content.base]):
        yield each | {"varied": each["parameter"] in varied}


def _summary(document: Mapping[str, Any], most_cases: int) -> Iterator[Row]:
    for name in ("name", "title", "cases", "met"):
        yield {"what": name, "value": document[name]}
    for outcome, count in document["outcomes"].items():
        yield {"what": f"outcome {outcome}", "value": count}
    for key, counts in document["rates"].items():
        yield {"what": key, "value": swept_words([count["value"] for count in counts])}
    if document["cases"] > most_cases:
        yield {"what": "note", "value": left_out(document["cases"], most_cases)}
    yield from ({"what": "note", "value": note} for note in document["notes"])
    for found in document["distributions"]:
        own = {name: found[name] for name in ("unit", "cases", "minimum", "mean", "maximum")}
        yield {"what": found["measure"], **own}


def _rates(rates: Mapping[str, Sequence[Mapping[str, Any]]]) -> Iterator[Row]:
    for key, counts in rates.items():
        for count in counts:
            cases, met = count["cases"], count["met"]
            own: Row = {"cases": cases, "met": met, "share_met": met / cases if cases else None}
            yield {"parameter": key, "value": count["value"], **own, **count["outcomes"]}


def _frontier(frontier: Mapping[str, Any]) -> Iterator[Row]:
    for stretch in frontier["stretches"]:
        at: Row = {f"at {key}": text for key, text in stretch["circumstances"].items()}
        end: Row = {"flips": len(stretch["flips"]), "note": stretch["note"]}
        for flip in stretch["flips"] or ({"low": None, "high": None, "met_at_low": None},):
            own: Row = {"from": flip["low"], "to": flip["high"], "met_at_from": flip["met_at_low"]}
            yield {**at, **own, **end}


def _sensitivities(found: Sequence[Mapping[str, Any]]) -> Iterator[Row]:
    for each in found:
        at: Row = {f"at {key}": text for key, text in each["circumstances"].items()}
        row: Row = {"measure": each["measure"], "parameter": each["key"], **at}
        for kind in ("first", "total"):
            row |= {kind: each[kind]["value"]}
            row |= {f"{kind}_{end}": each[kind][end] for end in ("low", "high")}
        yield row


def _worst(content: SweepContent) -> Iterator[Row]:
    results = {result.id: result for result in content.worst}
    for case in notable_cases(content):
        row: Row = {"case": case.id, "verdict": case.word, "outcome": case.outcome}
        result = results.get(case.id)
        yield row | (result_row(result) if result else {}) | {"why": case.why}
