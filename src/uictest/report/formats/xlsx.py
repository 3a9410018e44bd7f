"""The workbook: the tables of the CSV files, a sheet for each."""

from __future__ import annotations

from uictest.report.formats import ReportFormat
from uictest.report.formats.csv import run_tables
from uictest.report.workbook import workbook_bytes

FORMAT = ReportFormat(lambda content: {"report.xlsx": workbook_bytes(run_tables(content))})
