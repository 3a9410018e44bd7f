"""Write a study into a folder: its data as CSV, its figures as SVG and PNG."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from pathlib import Path

from uictest.recording import atomic_path, write_text_atomic
from uictest.studies.comparison import comparison_table
from uictest.studies.document import document
from uictest.studies.figures.style import RC
from uictest.studies.study import Drawing, StudyResult, Table


def write_tables(folder: Path, result: StudyResult) -> list[Path]:
    """Write the tables of a study into its folder below `folder`, and return the files. Raises OSError."""
    place = _place(folder, result)
    written = []
    for name, table in result.findings.tables.items():
        path = place / f"{name}.csv"
        write_text_atomic(path, table_text(table))
        written.append(path)
    return written


def write_comparison(folder: Path, results: Sequence[StudyResult]) -> None:
    """Write the comparison with the paper into `comparison.csv` and `studies.json`. Raises OSError."""
    folder.mkdir(parents=True, exist_ok=True)
    write_text_atomic(folder / "comparison.csv", table_text(comparison_table(results)))
    write_text_atomic(folder / "studies.json", document(results) + "\n")


def write_figures(folder: Path, result: StudyResult) -> list[Path]:
    """Draw the figures of a study into its folder below `folder`, and return the files.

    Raises ImportError where matplotlib is not installed, OSError where a file cannot be written.
    """
    import matplotlib as mpl

    place = _place(folder, result)
    with mpl.rc_context(RC):
        return [
            path
            for name, drawing in result.findings.drawings.items()
            for path in _draw(drawing, place / name)
        ]


def table_text(table: Table) -> str:
    """Return a table as CSV: comma, line feed, header first; None and NaN stay empty."""
    buffer = io.StringIO(newline="")
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(table)
    writer.writerows([_cell(value) for value in row] for row in zip(*table.values(), strict=True))
    return buffer.getvalue()


def _cell(value: object) -> str:
    return "" if value is None or value != value else str(value)


def _place(folder: Path, result: StudyResult) -> Path:
    place = folder / result.study.name
    place.mkdir(parents=True, exist_ok=True)
    return place


def _draw(drawing: Drawing, path: Path) -> list[Path]:
    from matplotlib.figure import Figure

    figure = Figure(layout="constrained")
    drawing(figure)
    written = [path.with_name(f"{path.name}.{suffix}") for suffix in ("svg", "png")]
    for each in written:
        # A date would make every SVG differ from the one before it.
        metadata = {"Date": None} if each.suffix == ".svg" else None
        with atomic_path(each) as temporary:
            figure.savefig(temporary, metadata=metadata)
    return written
