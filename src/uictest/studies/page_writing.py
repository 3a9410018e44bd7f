"""Write the pages of studies beside their data and figures."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from pathlib import Path
from typing import Final

from uictest import report
from uictest.core import files
from uictest.studies.page import STUDIES_MARK, STUDY_MARK, StudyFigure, studies_html, study_html
from uictest.studies.study import Study, StudyResult

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
    manifest = report.run_manifest(arguments, None, {}, 0)
    pages.append((_PAGE, STUDIES_MARK, studies_html(results, earlier, manifest)))
    return [problem for page in pages for problem in _write(folder, *page)]


def _study_page(folder: Path, result: StudyResult, arguments: Sequence[str], drawn: Collection[Path]) -> str:
    manifest = report.run_manifest(arguments, None, result.inputs, 0)
    return study_html(result, list(_figures(folder / result.study.name, result, drawn)), manifest)


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
