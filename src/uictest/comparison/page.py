"""The page of a comparison."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

from uictest.comparison.difference import Comparison
from uictest.comparison.paired.pairing import PairedComparison
from uictest.comparison.paired.wording import (
    HEADINGS,
    METHOD,
    differing_rows,
    group_text,
    same_text,
)
from uictest.comparison.wording import verdict_line
from uictest.report import listed, number, side_text
from uictest.report.page import overlay_view, render

_PAIRED: Final[dict[str, Any]] = {
    "paired_headings": HEADINGS,
    "paired_method": METHOD,
    "differing_rows": differing_rows,
    "group_text": group_text,
    "same_text": same_text,
}
"""What the tables of paired differences are made with."""


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
        paired=[] if comparison.paired is None else [comparison.paired],
        **_PAIRED,
    )


def variants_html(run: str, compared: Sequence[PairedComparison]) -> str:
    """Return one page with the paired differences of the variants of a run; it loads nothing."""
    return render("variants.html.j2", run=run, paired=compared, with_plots=False, **_PAIRED)
