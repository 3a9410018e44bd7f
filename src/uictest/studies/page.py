"""A page for each study, and one that lists them: one document each, which loads nothing."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from markupsafe import Markup

from uictest import report
from uictest.report.page import render
from uictest.studies import band_plot
from uictest.studies.comparison import (
    band_text,
    claim_counts,
    declared_misses,
    ours_text,
    paper_text,
    result_text,
    tally,
)
from uictest.studies.quantity import PaperComparison
from uictest.studies.study import Study, StudyResult

STUDY_MARK: Final = "uictest/study-page/1"
STUDIES_MARK: Final = "uictest/studies-page/1"
_TONES: Final[Mapping[str, str]] = {"holds": "good", "misses": "odd", "shown": "none"}
"""Of results; one that fails its study is `bad`."""
_TYPES: Final = {".svg": "image/svg+xml", ".png": "image/png"}


@dataclass(frozen=True, slots=True)
class StudyFigure:
    """A figure: its name, and the file that the page holds."""

    name: str
    file: Path

    @property
    def source(self) -> Markup:
        """The file as a URL of its own."""
        content = b64encode(self.file.read_bytes()).decode("ascii")
        return Markup(f"data:{_TYPES[self.file.suffix]};base64,{content}")


@dataclass(frozen=True, slots=True)
class QuantityRow:
    """A quantity of a study as the page shows it."""

    comparison: PaperComparison
    ours: str
    band: str
    result: str
    plot: band_plot.BandPlot | None


def study_html(result: StudyResult, figures: Sequence[StudyFigure], manifest: report.RunManifest) -> str:
    """Return the page of a study. Raises OSError where a figure cannot be read."""
    return render(
        "study.html.j2",
        with_plots=False,
        running_head=result.study.name,
        mark=STUDY_MARK,
        result=result,
        study=result.study,
        paper=paper_text(result.study),
        tally=tally([result]),
        declared=declared_misses(result),
        rows=[_row(each) for each in result.comparisons],
        figures=figures,
        content={"manifest": manifest},
        **_words(),
    )


def studies_html(
    results: Sequence[StudyResult], earlier: Sequence[Study], manifest: report.RunManifest
) -> str:
    """Return the list of studies; `earlier` are those with a page from an earlier run."""
    return render(
        "studies.html.j2",
        with_plots=False,
        running_head="studies",
        mark=STUDIES_MARK,
        results=results,
        earlier=earlier,
        failed=sum(each.fails for each in results),
        counts=claim_counts(results),
        tally=tally,
        content={"manifest": manifest},
        **_words(),
    )


def _words() -> dict[str, Any]:
    return {
        "counted": report.counted,
        "tones": _TONES,
        "plot_width": band_plot.WIDTH,
        "plot_height": band_plot.HEIGHT,
    }


def _row(comparison: PaperComparison) -> QuantityRow:
    return QuantityRow(
        comparison,
        ours_text(comparison),
        band_text(comparison.quantity),
        result_text(comparison),
        band_plot.band_plot(comparison),
    )
