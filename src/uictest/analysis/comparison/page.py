"""The page of a comparison."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

from uictest.analysis.comparison.difference import Comparison
from uictest.analysis.comparison.overlay import Overlay
from uictest.analysis.comparison.overlay_panels import sampling_text, view_of
from uictest.analysis.comparison.paired.pairing import PairedComparison
from uictest.analysis.comparison.paired.wording import (
    HEADINGS,
    METHOD,
    differing,
    group_text,
    paired_cells,
    paired_percent,
    same_text,
)
from uictest.analysis.comparison.shown_differences import in_page_units, quantity_title
from uictest.analysis.comparison.wording import verdict_line
from uictest.core.recording import state_kind
from uictest.report import Difference, Value, channel_title, counted, listed, number, relative_text, side_text
from uictest.report.page import OverlayView, case_anchor, fragment, render

_PAIRED: Final[dict[str, Any]] = {
    "paired_headings": HEADINGS,
    "paired_method": METHOD,
    "differing": differing,
    "paired_cells": paired_cells,
    "group_text": group_text,
    "same_text": same_text,
    "paired_mean": HEADINGS.index("mean"),
    "paired_percent": paired_percent,
}
"""What the tables of paired differences are made with."""


@dataclass(frozen=True, slots=True)
class DrawnOverlay:
    """An overlay with its drawings; `anchor` is that of its part of the page."""

    overlay: Overlay
    view: OverlayView

    @property
    def anchor(self) -> str:
        """The anchor of its part of the page: it follows from the id of the case alone."""
        return case_anchor(self.overlay.title)

    @property
    def fragment(self) -> str:
        """What stands behind the `#` of a link to it."""
        return fragment(self.anchor)


def comparison_html(comparison: Comparison) -> str:
    """Return one page with the differences and both sides drawn over each other; it loads nothing."""
    overlays = [DrawnOverlay(overlay, view_of(overlay)) for overlay in comparison.overlays]
    stated = {remark for each in overlays for remark in each.overlay.remarks}
    return render(
        "comparison.html.j2",
        comparison=comparison,
        notes=[note for note in comparison.notes if note not in stated],
        overlays=overlays,
        fragments={each.overlay.title: each.fragment for each in overlays},
        verdict_line=verdict_line(comparison),
        signed_deviation=signed_deviation,
        relative_cell=relative_cell,
        sampling_text=sampling_text,
        state_kind=state_kind,
        differences=[in_page_units(each) for each in comparison.differences],
        with_cases=any(each.case for each in comparison.differences),
        with_remarks=any(each.remark for each in comparison.differences),
        quantity_title=quantity_title,
        channel_title=channel_title,
        number=number,
        side_text=side_text,
        listed=listed,
        counted=counted,
        with_plots=bool(overlays),
        running_head=f"{comparison.first} and {comparison.second}",
        paired=[] if comparison.paired is None else [comparison.paired],
        **_PAIRED,
    )


def signed_deviation(difference: Difference) -> str:
    """Return second - first with its sign; `-` where the sides cannot be subtracted."""
    first, second = difference.first, difference.second
    if isinstance(first, str) or isinstance(second, str) or difference.deviation is None:
        return "-"
    return f"{second - first:+.5g}"


def relative_cell(quantity: str, first: Value, second: Value, unit: str) -> str:
    """Return by how many per cent of A's size B exceeds A, or why it is not said; states have no size."""
    return "-" if state_kind(quantity) else relative_text(first, second, unit)


def variants_html(run: str, compared: Sequence[PairedComparison]) -> str:
    """Return one page with the paired differences of the variants of a run; it loads nothing."""
    return render("variants.html.j2", run=run, paired=compared, with_plots=False, running_head=run, **_PAIRED)
