"""The formats made for people: which there are, and the file each becomes."""

from __future__ import annotations

from collections.abc import Iterable
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING

from uictest import recording

if TYPE_CHECKING:
    from uictest.report.content import RunContent


class ReportFormat(StrEnum):
    """A format that can be asked for."""

    CSV = "csv"
    XLSX = "xlsx"
    HTML = "html"
    MD = "md"


def write_formats(folder: Path, content: RunContent, formats: Iterable[ReportFormat]) -> list[Path]:
    """Write a run in further formats into a folder, and return the files. Raises OSError."""
    return [path for wanted in formats for path in _write(folder, content, wanted)]


def _write(folder: Path, content: RunContent, wanted: ReportFormat) -> list[Path]:
    files = {folder / name: data for name, data in _files(content, wanted).items()}
    for path, data in files.items():
        recording.write_bytes_atomic(path, data)
    return list(files)


def _files(content: RunContent, wanted: ReportFormat) -> dict[str, bytes]:
    if wanted is ReportFormat.HTML:
        from uictest.report.page import page_html

        # What is no UTF-8 in a file name is spelled out already, like all that cannot be printed.
        return {"index.html": page_html(content).encode()}
    if wanted is ReportFormat.XLSX:
        from uictest.report.workbook import workbook_bytes

        return {"report.xlsx": workbook_bytes(content)}
    if wanted is ReportFormat.MD:
        from uictest.report.markdown import markdown_summary

        return {"summary.md": markdown_summary(content).encode()}
    from uictest.report.run_report import csv_files

    return {name: text.encode() for name, text in csv_files(content.results).items()}
