"""The tables of series: CSV files and sheets of a workbook."""

from __future__ import annotations

from collections.abc import Sequence

from uictest.report.csv_text import csv_text
from uictest.report.series.rows import Row, criterion_rows, measure_rows, series_rows, stop_rows
from uictest.series import SeriesResult


def series_tables(results: Sequence[SeriesResult]) -> dict[str, str]:
    """Return the CSV files of series by name: measures, criteria, stops; none without any series."""
    if not results:
        return {}
    tables = {
        "series.csv": list(measure_rows(results)),
        "series-criteria.csv": list(criterion_rows(results)),
        "series-stops.csv": list(stop_rows(results)),
    }
    return {name: csv_text(_columns(rows), rows) for name, rows in tables.items()}


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


def _columns(rows: Sequence[Row]) -> list[str]:
    """Return every column of any of the rows, in the order of their first use."""
    return list(dict.fromkeys(column for row in rows for column in row))
