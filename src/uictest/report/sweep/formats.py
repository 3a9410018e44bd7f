"""The files that a sweep is reported in: what they need is loaded when one is written."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

from uictest.core import files

if TYPE_CHECKING:
    from uictest.report.sweep.folder import SweepContent


def write_sweep_formats(folder: Path, content: SweepContent, names: Iterable[str]) -> list[Path]:
    """Write a sweep in some formats into a folder, and return the files.

    Raises OSError, and ValueError where summary.parquet cannot be read.
    """
    paths = []
    for name in names:
        if name == "csv":
            # Its own folder has the tables from the beginning.
            paths += [_copied(table, folder) for table in sorted(content.folder.glob("*.csv"))]
        else:
            file, to_bytes = _ONE_FILE[name]
            files.write(folder, file, to_bytes(content))
            paths.append(folder / file)
    return paths


def load_sweep_formats(names: Iterable[str]) -> None:
    """Load what some formats are written with, which takes longer than to write a small sweep."""
    if "html" in names:
        from uictest.report import page

        page.load_sweep_page()


def _copied(table: Path, folder: Path) -> Path:
    """Return the table in a folder; where it is not yet, it is copied."""
    target = folder / table.name
    if target.resolve() != table.resolve():
        with files.new_file(folder, table.name) as copy, table.open("rb") as rows:
            shutil.copyfileobj(rows, copy)
    return target


def _page(content: SweepContent) -> bytes:
    from uictest.report import page

    return page.sweep_page_html(content).encode()


def sweep_markdown(content: SweepContent, limit: int | None = None) -> str:
    """Return the summary: counts, the map of verdicts, the worst cases, and what they depend on.

    What would go beyond `limit` bytes, or else those that GitHub shows, is left out, and lines say how much
    that is.
    """
    from uictest.report.github import LIMIT
    from uictest.report.sweep.summary_tables import sweep_summary
    from uictest.report.text_tables import document_markdown

    return document_markdown(sweep_summary(content.result), LIMIT if limit is None else limit, level=2)


def append_sweep_step_summary(content: SweepContent) -> None:
    """Append the summary to the file that GitHub Actions names, where it does. Raises OSError."""
    from uictest.report.github import append_to_step_summary

    append_to_step_summary(partial(sweep_markdown, content))


def _workbook(content: SweepContent) -> bytes:
    from uictest.report.sweep.cases import SummaryRows
    from uictest.report.sweep.tables import sweep_tables
    from uictest.report.workbook import workbook_bytes

    return workbook_bytes({"summary": SummaryRows(content.folder).table(), **sweep_tables(content.result)})


_ONE_FILE: Final[Mapping[str, tuple[str, Callable[[SweepContent], bytes]]]] = MappingProxyType(
    {
        "html": ("index.html", _page),
        "md": ("summary.md", lambda content: sweep_markdown(content).encode()),
        "xlsx": ("report.xlsx", _workbook),
    }
)
"""Format -> the file that it writes, and its content."""


def sweep_format_names() -> tuple[str, ...]:
    """Return the names of all formats of sweeps, in alphabetical order."""
    return ("csv", *_ONE_FILE)
