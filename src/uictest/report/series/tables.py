"""The tables of series: CSV files and sheets of a workbook."""

from __future__ import annotations

from collections.abc import Sequence

from uictest.judging.series import SeriesResult
from uictest.report.csv_text import Table
from uictest.report.series.rows import Row, criterion_rows, measure_rows, series_rows, stop_rows


def series_tables(results: Sequence[SeriesResult]) -> dict[str, Table]:
    """Return the tables of series by the names of their files: measures, criteria, stops."""
    return {
        "series": Table.of(list(measure_rows(results))),
        "series-criteria": Table.of(list(criterion_rows(results))),
        "series-stops": Table.of(list(stop_rows(results))),
    }


def series_sheets(results: Sequence[SeriesResult]) -> dict[str, list[Row]]:
    """Return the rows of the sheets of series by name; none without any series."""
    if not results:
        return {}
    return {
        "Series": list(series_rows(results)),
        "Series criteria": list(criterion_rows(results)),
        "Series measures": list(measure_rows(results)),
        "Series stops": list(stop_rows(results)),
    }
