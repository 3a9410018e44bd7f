"""Charts on the summary of a sweep's workbook: how the first measure is distributed, and its first trend."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

from uictest.report.charts import Cells, Plotted, histogram_chart, line_chart
from uictest.report.sheet import columns_of, heading_rows
from uictest.report.sweep.result import MeasureHistogram, SweepResult, Trend
from uictest.report.sweep.tables import distribution_rows, trend_rows

if TYPE_CHECKING:
    from xlsxwriter import Workbook
    from xlsxwriter.chart import Chart
    from xlsxwriter.worksheet import Worksheet

SUMMARY_SHEET: Final = "Summary"
DISTRIBUTIONS_SHEET: Final = "Distributions"
TRENDS_SHEET: Final = "Trends"
_ROWS_OF_A_CHART: Final = 17


def insert_charts(workbook: Workbook, summary: Worksheet, result: SweepResult) -> None:
    """Draw the first distribution and the first trend beside the summary; each only where there is one."""
    charts = [
        *(_distribution(workbook, result, each) for each in result.distributions[:1]),
        *(_trend(workbook, each) for each in result.trends[:1]),
    ]
    for number, chart in enumerate(charts):
        summary.insert_chart(1 + number * _ROWS_OF_A_CHART, 9, chart)


def _distribution(workbook: Workbook, result: SweepResult, histogram: MeasureHistogram) -> Chart:
    """Return the cases in each bin, by outcome. The bins are the first rows of their sheet."""
    columns = columns_of(row for each in result.distributions for row in distribution_rows(each))
    cells = _first_rows(DISTRIBUTIONS_SHEET, columns, len(histogram.edges) - 1)
    plotted = [
        Plotted(outcome, cells[outcome], "good" if outcome == "pass" else "bad")
        for outcome in histogram.counts
    ]
    title = f"Cases by {_words(histogram.measure)}, {histogram.unit} (lower end of each bin)"
    return histogram_chart(workbook, title, cells["from"], plotted)


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
