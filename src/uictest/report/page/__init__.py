"""index.html: one page that explains a run or a sweep at a glance and needs nothing but itself."""

from uictest.report.page.page import page_html
from uictest.report.page.ranking import DRAWN, worst_first
from uictest.report.page.sweep_page import sweep_page_html
from uictest.report.page.trace import Trace, trace_of

__all__ = ["DRAWN", "Trace", "page_html", "sweep_page_html", "trace_of", "worst_first"]
