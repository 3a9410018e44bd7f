"""A page for each study, and one that lists them, beside their data and figures."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

from markupsafe import Markup

from studies.comparison import (
    band_text,
    claim_counts,
    declared_misses,
    ours_text,
    paper_text,
    result_text,
    tally,
)
from studies.quantity import HEIGHT, WIDTH, BandPlot, PaperComparison, band_plot
from studies.study import Study, StudyResult
from uictest import report
from uictest.core import files
from uictest.report.page import render

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
    plot: BandPlot | None


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
        "plot_width": WIDTH,
        "plot_height": HEIGHT,
    }


def _row(comparison: PaperComparison) -> QuantityRow:
    return QuantityRow(
        comparison,
        ours_text(comparison),
        band_text(comparison.quantity),
        result_text(comparison),
        band_plot(comparison),
    )


_PAGE: Final = "index.html"


def write_pages(
    folder: Path,
    results: Sequence[StudyResult],
    known: Sequence[Study],
    arguments: Sequence[str],
    drawn: Collection[Path] = (),
) -> list[str]:
    """Write a page per study and one that lists them; return which pages were not written, and why.

    A page of somebody else is left alone.

    Args:
        folder: of the studies.
        results: of this run.
        known: every study; of those that were not run the list names pages from earlier runs.
        arguments: the command line.
        drawn: the files of the figures of this run; another that an earlier run drew is not shown.

    Raises:
        OSError: a page cannot be written.

    """
    pages = [
        (f"{each.study.name}/{_PAGE}", STUDY_MARK, _study_page(folder, each, arguments, drawn))
        for each in results
    ]
    names = {each.study.name for each in results}
    earlier = [study for study in known if study.name not in names and _has_page(folder / study.name)]
    manifest = _manifest(arguments, {})
    pages.append((_PAGE, STUDIES_MARK, studies_html(results, earlier, manifest)))
    return [problem for page in pages for problem in _write(folder, *page)]


def _study_page(folder: Path, result: StudyResult, arguments: Sequence[str], drawn: Collection[Path]) -> str:
    manifest = _manifest(arguments, result.inputs)
    return study_html(result, list(_figures(folder / result.study.name, result, drawn)), manifest)


def _manifest(arguments: Sequence[str], inputs: Mapping[str, str]) -> report.RunManifest:
    manifest = report.run_manifest(arguments, None, inputs, 0)
    return replace(manifest, command=("./reproduce", *manifest.command[1:]))


def _figures(place: Path, result: StudyResult, drawn: Collection[Path]) -> Iterator[StudyFigure]:
    """Yield each figure that was drawn, as the smaller of its files."""
    for name in result.findings.drawings:
        files = [file for suffix in (".svg", ".png") if (file := place / f"{name}{suffix}") in drawn]
        if files:
            yield StudyFigure(name, min(files, key=lambda file: file.stat().st_size))


def _has_page(place: Path) -> bool:
    return (place / _PAGE).is_file()


def _write(folder: Path, name: str, mark: str, page: str) -> Iterator[str]:
    """Write a page; yield why not, where it is not ours."""
    if report.may_replace(folder / name, mark):
        files.make_folder(folder)
        files.write(folder, name, page)
    else:
        yield f"{folder / name} is a page of something else: it is left as it is"
