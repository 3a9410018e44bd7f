"""Write a study into a folder: its data as CSV, its figures as SVG and PNG, its page."""

from __future__ import annotations

import io
from base64 import b64encode
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

from markupsafe import Markup

from studies.comparison import (
    band_text,
    claim_counts,
    comparison_table,
    declared_misses,
    document,
    ours_text,
    paper_text,
    result_text,
    tally,
)
from studies.drawing import RC
from studies.quantity import HEIGHT, WIDTH, band_plot
from studies.study import Drawing, Study, StudyResult, Table
from uictest import report
from uictest.core import files
from uictest.report.page import render


def write_tables(folder: Path, result: StudyResult) -> list[Path]:
    """Write the tables of a study into its folder below `folder`, and return the files. Raises OSError."""
    files.make_folder(folder)
    tables = {f"{result.study.name}/{name}.csv": table for name, table in result.findings.tables.items()}
    for name, table in tables.items():
        files.write(folder, name, table_text(table))
    return [folder / name for name in tables]


def write_comparison(folder: Path, results: Sequence[StudyResult]) -> None:
    """Write the comparison with the paper into `comparison.csv` and `studies.json`. Raises OSError."""
    files.make_folder(folder)
    files.write(folder, "comparison.csv", table_text(comparison_table(results)))
    files.write(folder, "studies.json", document(results) + "\n")


def write_figures(folder: Path, result: StudyResult) -> list[Path]:
    """Draw the figures of a study into its folder below `folder`, and return the files.

    Raises ImportError where matplotlib is not installed, OSError where a file cannot be written.
    """
    import matplotlib as mpl

    files.make_folder(folder)
    with mpl.rc_context(RC):
        return [
            path
            for name, drawing in result.findings.drawings.items()
            for path in _draw(drawing, folder, f"{result.study.name}/{name}")
        ]


def table_text(table: Table) -> str:
    """Return a table as CSV: comma, line feed, header first; None and NaN stay empty."""
    import pandas as pd

    return pd.DataFrame(dict(table), dtype=object).to_csv(index=False, lineterminator="\n")


def _draw(drawing: Drawing, folder: Path, name: str) -> list[Path]:
    from matplotlib.figure import Figure

    figure = Figure(layout="constrained")
    drawing(figure)
    for suffix in ("svg", "png"):
        content = io.BytesIO()
        # A date would make every SVG differ from the one before it.
        figure.savefig(content, format=suffix, metadata={"Date": None} if suffix == "svg" else None)
        files.write(folder, f"{name}.{suffix}", content.getvalue())
    return [folder / f"{name}.{suffix}" for suffix in ("svg", "png")]


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


def _study_page(folder: Path, result: StudyResult, arguments: Sequence[str], drawn: Collection[Path]) -> str:
    rows = [
        {
            "comparison": each,
            "ours": ours_text(each),
            "band": band_text(each.quantity),
            "result": result_text(each),
            "plot": band_plot(each),
        }
        for each in result.comparisons
    ]
    return render(
        "study.html.j2",
        running_head=result.study.name,
        mark=STUDY_MARK,
        result=result,
        study=result.study,
        paper=paper_text(result.study),
        tally=tally([result]),
        declared=declared_misses(result),
        rows=rows,
        figures=list(_figures(folder / result.study.name, result, drawn)),
        **_common(arguments, result.inputs),
    )


def _list_page(results: Sequence[StudyResult], earlier: Sequence[Study], arguments: Sequence[str]) -> str:
    """Return the list of studies; `earlier` are those with a page from an earlier run."""
    return render(
        "studies.html.j2",
        running_head="studies",
        mark=STUDIES_MARK,
        results=results,
        earlier=earlier,
        failed=sum(each.fails for each in results),
        counts=claim_counts(results),
        tally=tally,
        **_common(arguments, {}),
    )


def _common(arguments: Sequence[str], inputs: Mapping[str, str]) -> dict[str, Any]:
    """Return what both kinds of pages are filled in with."""
    manifest = report.run_manifest(arguments, None, inputs, 0)
    command = ("./reproduce", *manifest.command[1:])
    return {
        "with_plots": False,
        "content": {"manifest": replace(manifest, command=command)},
        "counted": report.counted,
        "tones": _TONES,
        "plot_width": WIDTH,
        "plot_height": HEIGHT,
    }


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
    earlier = [
        study for study in known if study.name not in names and (folder / study.name / _PAGE).is_file()
    ]
    pages.append((_PAGE, STUDIES_MARK, _list_page(results, earlier, arguments)))
    return [problem for page in pages for problem in _write(folder, *page)]


def _figures(place: Path, result: StudyResult, drawn: Collection[Path]) -> Iterator[StudyFigure]:
    """Yield each figure that was drawn, as the smaller of its files."""
    for name in result.findings.drawings:
        files = [file for suffix in (".svg", ".png") if (file := place / f"{name}{suffix}") in drawn]
        if files:
            yield StudyFigure(name, min(files, key=lambda file: file.stat().st_size))


def _write(folder: Path, name: str, mark: str, page: str) -> Iterator[str]:
    """Write a page; yield why not, where it is not ours."""
    if report.may_replace(folder / name, mark):
        files.make_folder(folder)
        files.write(folder, name, page)
    else:
        yield f"{folder / name} is a page of something else: it is left as it is"
