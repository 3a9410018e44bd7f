"""The result of a sweep as tables: rows for workbooks and their charts, and CSV files."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Final

from uictest.core.document import Cell
from uictest.report.cover_sheet import Cells, Plotted, line_chart
from uictest.report.firmness_sentences import firmness_rows
from uictest.report.sheet import columns_of, heading_rows
from uictest.report.sweep.result import (
    Frontier,
    SweepMap,
    SweepResult,
    Trend,
)
from uictest.report.text_tables import csv_text

if TYPE_CHECKING:
    from xlsxwriter import Workbook
    from xlsxwriter.chart import Chart
    from xlsxwriter.worksheet import Worksheet


TREND_COLUMNS: Final = ("parameter", "value", "measure", "unit", "cases", "minimum", "mean", "maximum")
_RATE_COLUMNS: Final = ["parameter", "value", "cases", "met", "share_met"]
_FRONTIER_COLUMNS: Final = ("from", "to", "met_at_from", "flips", "note")
_INDEX_COLUMNS: Final = [f"{order}{end}" for order in ("first", "total") for end in ("", "_low", "_high")]


def csv_tables(result: SweepResult) -> dict[str, str]:
    """Return the CSV files of a sweep besides its summary, by file name."""
    tables = {
        "rates.csv": csv_text([*_RATE_COLUMNS, *result.outcomes], rate_rows(result)),
        **{f"map-{each.measure}.csv": map_csv(each) for each in result.maps},
        "trends.csv": csv_text(TREND_COLUMNS, (row for trend in result.trends for row in trend_rows(trend))),
    }
    if result.sensitivities:
        tables["sensitivity.csv"] = sensitivity_csv(result)
    if result.frontier is not None:
        tables["frontier.csv"] = frontier_csv(result.frontier)
    if rows := list(firmness_of_nominal(result)):
        tables["firmness.csv"] = csv_text(list(rows[0]), rows)
    return tables


def rate_rows(result: SweepResult) -> Iterator[dict[str, Cell]]:
    """Yield a row of counts for each value of each parameter."""
    for parameter, counts in result.rates.items():
        for count in counts:
            own: dict[str, Cell] = {"cases": count.cases, "met": count.met, "share_met": count.share_met}
            yield {"parameter": parameter, "value": count.value.label, **own, **count.outcomes}


def trend_rows(trend: Trend) -> Iterator[dict[str, Cell]]:
    """Yield a row for each value of the parameter."""
    own: dict[str, Cell] = {"parameter": trend.parameter, "measure": trend.measure, "unit": trend.unit}
    columns = (trend.values, trend.cases, trend.minimum, trend.mean, trend.maximum)
    for value, cases, minimum, mean, maximum in zip(*columns, strict=True):
        numbers: dict[str, Cell] = {"cases": cases, "minimum": minimum, "mean": mean, "maximum": maximum}
        yield {**own, "value": value.label, **numbers}


def sensitivity_rows(result: SweepResult, prefix: str = "") -> Iterator[dict[str, Cell]]:
    """Yield a row for each measure and parameter; circumstances are columns with a prefix."""
    for sensitivity in result.sensitivities:
        at: dict[str, Cell] = {
            f"{prefix}{key}": value.text for key, value in sensitivity.circumstances.items()
        }
        own: dict[str, Cell] = {"measure": sensitivity.measure, "parameter": sensitivity.key}
        indices = (sensitivity.first, sensitivity.total)
        numbers = [number for index in indices for number in (index.value, index.low, index.high)]
        yield {**own, **at, **dict(zip(_INDEX_COLUMNS, numbers, strict=True))}


def frontier_rows(frontier: Frontier, prefix: str = "") -> Iterator[dict[str, Cell]]:
    """Yield a row for each flip, or one with a note where there is none; circumstances as columns."""
    for scan in frontier.scans:
        at: dict[str, Cell] = {f"{prefix}{key}": value.text for key, value in scan.circumstances.items()}
        for flip in scan.flips or (None,):
            cells: dict[str, Cell] = {"from": None, "to": None, "met_at_from": None}
            if flip is not None:
                cells = {"from": flip.low.text, "to": flip.high.text, "met_at_from": flip.met_at_low}
            yield {**at, **cells, "flips": len(scan.flips), "note": scan.note}


def firmness_of_nominal(result: SweepResult) -> Iterator[dict[str, Cell]]:
    """Yield a row for each ranged number and criterion of the nominal cases; nothing where nobody asked."""
    for nominal in result.nominal:
        if nominal.firmness is not None:
            yield from firmness_rows(nominal.id, nominal.firmness)


def map_csv(sweep_map: SweepMap) -> str:
    """Return a map as CSV: a line per value of the first parameter, a column per value of the other."""
    corner = f"{sweep_map.rows.parameter} \\ {sweep_map.columns.parameter}"
    columns = [corner, *(value.label for value in sweep_map.columns.values)]
    lines = zip(sweep_map.rows.values, sweep_map.means, strict=True)
    return csv_text(
        columns, (dict(zip(columns, [value.label, *means], strict=True)) for value, means in lines)
    )


def frontier_csv(frontier: Frontier) -> str:
    """Return the frontier as CSV."""
    return csv_text([*frontier.scans[0].circumstances, *_FRONTIER_COLUMNS], frontier_rows(frontier))


def sensitivity_csv(result: SweepResult) -> str:
    """Return the Sobol indices as CSV."""
    circumstances = list(result.sensitivities[0].circumstances)
    return csv_text(["measure", *circumstances, "parameter", *_INDEX_COLUMNS], sensitivity_rows(result))


SUMMARY_SHEET: Final = "Summary"
TRENDS_SHEET: Final = "Trends"


def insert_charts(workbook: Workbook, summary: Worksheet, result: SweepResult) -> None:
    """Draw the first trend beside the summary, where there is one."""
    for each in result.trends[:1]:
        summary.insert_chart(1, 9, _trend(workbook, each))


def _trend(workbook: Workbook, trend: Trend) -> Chart:
    """Return mean, minimum and maximum at each value. Its rows are the first of their sheet."""
    cells = _first_rows(TRENDS_SHEET, columns_of(trend_rows(trend)), len(trend.values))
    plotted = [Plotted("mean", cells["mean"])]
    plotted += [Plotted(name, cells[name], "odd") for name in ("minimum", "maximum")]
    title = f"{_words(trend.measure)}, {trend.unit}, over {trend.parameter}"
    return line_chart(workbook, title, cells["value"], plotted)


def _first_rows(sheet: str, columns: Sequence[str], rows: int) -> dict[str, Cells]:
    """Return the first cells of every column of a table on a sheet, by name."""
    top = heading_rows(columns)
    return {name: Cells(sheet, place, top, top + rows - 1) for place, name in enumerate(columns)}


def _words(measure: str) -> str:
    return measure.replace("_", " ")
