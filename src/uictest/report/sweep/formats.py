"""The formats made for people, of a sweep: which file each becomes."""

from __future__ import annotations

import shutil
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from uictest import recording
from uictest.report.formats import ReportFormat

if TYPE_CHECKING:
    from uictest.report.sweep.content import SweepContent


def write_sweep_formats(folder: Path, content: SweepContent, formats: Iterable[ReportFormat]) -> list[Path]:
    """Write a sweep in further formats into a folder, and return the files.

    Raises OSError, and ValueError where summary.parquet cannot be read.
    """
    return [path for wanted in formats for path in _write(folder, content, wanted)]


def _write(folder: Path, content: SweepContent, wanted: ReportFormat) -> list[Path]:
    if wanted is ReportFormat.CSV:
        return [_copied(table, folder) for table in sorted(content.folder.glob("*.csv"))]
    name, data = _file(content, wanted)
    recording.write_bytes_atomic(folder / name, data)
    return [folder / name]


def _file(content: SweepContent, wanted: ReportFormat) -> tuple[str, bytes]:
    if wanted is ReportFormat.HTML:
        from uictest.report.page import sweep_page_html

        return "index.html", sweep_page_html(content).encode()
    if wanted is ReportFormat.XLSX:
        from uictest.report.sweep.workbook import sweep_workbook_bytes

        return "report.xlsx", sweep_workbook_bytes(content)
    from uictest.report.sweep.markdown import sweep_markdown

    return "summary.md", sweep_markdown(content).encode()


def _copied(table: Path, folder: Path) -> Path:
    """Return the table in a folder; a sweep has its tables from the beginning, elsewhere they are copied."""
    target = folder / table.name
    if target.resolve() != table.resolve():
        with recording.atomic_path(target) as partial:
            shutil.copyfile(table, partial)
    return target
