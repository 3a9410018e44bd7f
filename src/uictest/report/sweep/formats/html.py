"""The page of a sweep."""

from __future__ import annotations

from uictest.report import page
from uictest.report.sweep.folder import one_file

FORMAT = one_file("index.html", lambda content: page.sweep_page_html(content).encode())
