"""Places on a page that links from elsewhere lead to: they follow from the id of a case or series alone."""

from __future__ import annotations

from urllib.parse import quote

from uictest.report.escaping import printable


def case_anchor(case_id: str) -> str:
    """Return the `id` of the element that shows a case, e.g. `case-slip-120[friction=0.09]`."""
    return f"case-{printable(case_id)}"


def series_anchor(series_id: str) -> str:
    """Return the `id` of the element that shows a series, e.g. `series-acceptance`."""
    return f"series-{printable(series_id)}"


def fragment(anchor: str) -> str:
    """Return an anchor as it stands behind the `#` of a link: percent-encoded."""
    return quote(anchor, safe="")
