"""The page of a comparison."""

from __future__ import annotations

from uictest.comparison.difference import Comparison
from uictest.comparison.wording import verdict_line
from uictest.report import listed, number, side_text
from uictest.report.page import overlay_view, render


def comparison_html(comparison: Comparison) -> str:
    """Return one page with the differences and both sides drawn over each other; it loads nothing."""
    overlays = [
        (overlay, overlay_view(f"overlay-{place}", overlay.title, overlay.trace, overlay.panels))
        for place, overlay in enumerate(comparison.overlays, start=1)
    ]
    return render(
        "comparison.html.j2",
        comparison=comparison,
        overlays=overlays,
        verdict_line=verdict_line(comparison),
        number=number,
        side_text=side_text,
        listed=listed,
        with_plots=bool(overlays),
    )
