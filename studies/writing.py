"""Write a study into a folder: its data as CSV, its figures as SVG and PNG."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from pathlib import Path

from studies.comparison import comparison_table
from studies.figures.style import RC
from studies.study import Drawing, StudyResult, Table
from studies.table import document
from uictest.core import files


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
    buffer = io.StringIO(newline="")
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(table)
    writer.writerows([_cell(value) for value in row] for row in zip(*table.values(), strict=True))
    return buffer.getvalue()


def _cell(value: object) -> str:
    return "" if value is None or value != value else str(value)


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
