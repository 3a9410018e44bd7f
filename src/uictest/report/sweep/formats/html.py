"""The page of a sweep."""

from __future__ import annotations

from uictest.report import page
from uictest.report.sweep.folder import SweepContent, one_file


def _page(content: SweepContent) -> bytes:
    return page.sweep_page_html(content).encode()


FORMAT = one_file("index.html", _page)
