"""The page: one HTML document that loads nothing."""

from __future__ import annotations

from uictest.report import page
from uictest.report.content import RunContent
from uictest.report.formats import ReportFormat


def _files(content: RunContent) -> dict[str, bytes]:
    # What is no UTF-8 in a file name is spelled out already, like all that cannot be printed.
    return {"index.html": page.page_html(content).encode()}


FORMAT = ReportFormat(_files, draws_stops=True)
