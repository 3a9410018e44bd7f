"""The page: one HTML document that loads nothing."""

from __future__ import annotations

from uictest.report import page
from uictest.report.formats import ReportFormat

# What is no UTF-8 in a file name is spelled out already, like all that cannot be printed.
FORMAT = ReportFormat(lambda content: {"index.html": page.page_html(content).encode()}, draws_stops=True)
