"""The workbook of a sweep: counts, cases, maps, trends, frontier, sensitivities, worst cases."""

from __future__ import annotations

import io
from collections.abc import Iterator

from uictest.report.formats.xlsx import manifest_rows, parameter_rows, result_row
from uictest.report.sheet import Row, open_workbook, styles_of, write_sheet
from uictest.report.sweep.cases import MOST_CASES, left_out, write_cases
from uictest.report.sweep.folder import SweepContent
from uictest.report.sweep.map_text import write_maps
from uictest.report.sweep.result import SweepResult
from uictest.report.sweep.sweep_sentences import notable_cases, swept_words
from uictest.report.sweep.tables import (
    SUMMARY_SHEET,
    TRENDS_SHEET,
    firmness_of_nominal,
    frontier_rows,
    insert_charts,
    rate_rows,
    sensitivity_rows,
    trend_rows,
)


def sweep_workbook_bytes(content: SweepContent, most_cases: int = MOST_CASES) -> bytes:
    """Return the workbook of a sweep. A sheet that would have no row is left out.

    Of more than `most_cases` cases the rest is left out; Summary and Cases say so. Raises OSError, and
    ValueError where summary.parquet cannot be read.
    """
    maps = content.result.maps
    buffer = io.BytesIO()
    with open_workbook(buffer, streaming=True) as workbook:
        styles = styles_of(workbook)
        summary = workbook.add_worksheet(SUMMARY_SHEET)
        write_sheet(summary, list(_summary(content.result, most_cases)), styles)
        write_cases(workbook.add_worksheet("Cases"), content.folder, styles, most_cases)
        if maps:
            write_maps(workbook.add_worksheet("Maps"), maps, styles)
        for name, rows in _tables(content).items():
            if rows:
                write_sheet(workbook.add_worksheet(name), rows, styles)
        insert_charts(workbook, summary, content.result)
    return buffer.getvalue()


def _tables(content: SweepContent) -> dict[str, list[Row]]:
    result = content.result
    return {
        "Rates": list(rate_rows(result)),
        TRENDS_SHEET: [row for trend in result.trends for row in trend_rows(trend)],
        "Frontier": list(frontier_rows(result.frontier, "at ")) if result.frontier else [],
        "Sensitivity": list(sensitivity_rows(result, "at ")),
        "Firmness": list(firmness_of_nominal(result)),
        "Worst cases": list(_worst(result)),
        "Parameters": list(_parameters(result)),
        "Provenance": list(manifest_rows(content.manifest)),
    }


def _parameters(result: SweepResult) -> Iterator[Row]:
    """Yield the parameters of the scenario that is varied."""
    for each in parameter_rows([result.base]):
        yield each | {"varied": each["parameter"] in result.varied}


def _summary(result: SweepResult, most_cases: int) -> Iterator[Row]:
    for name in ("name", "title", "cases", "met"):
        yield {"what": name, "value": getattr(result, name)}
    for outcome, count in result.outcomes.items():
        yield {"what": f"outcome {outcome}", "value": count}
    for key, counts in result.rates.items():
        yield {"what": key, "value": swept_words([each.value for each in counts])}
    if result.cases > most_cases:
        yield {"what": "note", "value": left_out(result.cases, most_cases)}
    for note in result.notes:
        yield {"what": "note", "value": note}
    for each in result.distributions:
        numbers: Row = {"minimum": each.minimum, "mean": each.mean, "maximum": each.maximum}
        yield {"what": each.measure, "unit": each.unit, "cases": each.cases, **numbers}


def _worst(result: SweepResult) -> Iterator[Row]:
    worst = {case.id: case for case in result.worst}
    for case in notable_cases(result):
        row: Row = {"case": case.id, "verdict": case.word, "outcome": case.outcome}
        yield row | (result_row(worst[case.id]) if case.id in worst else {}) | {"why": case.why}
