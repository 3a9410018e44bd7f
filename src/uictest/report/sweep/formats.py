"""A finished sweep in the formats of reports."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Final

from uictest import recording
from uictest.report import page
from uictest.report.sweep.content import SweepContent
from uictest.report.sweep.markdown import sweep_markdown
from uictest.report.sweep.workbook import sweep_workbook_bytes

_WRITERS: Final[Mapping[str, tuple[str, Callable[[SweepContent], bytes]]]] = MappingProxyType(
    {
        "html": ("index.html", lambda content: page.sweep_page_html(content).encode()),
        "md": ("summary.md", lambda content: sweep_markdown(content).encode()),
        "xlsx": ("report.xlsx", sweep_workbook_bytes),
    }
)
"""Format -> name of its file and what returns the bytes of that."""

_TABLES: Final = "csv"
"""The format that the folder of every sweep has."""


def write_sweep_formats(folder: Path, content: SweepContent, names: Iterable[str]) -> list[Path]:
    """Write a sweep in some formats into a folder, and return the files.

    Raises OSError, and ValueError where summary.parquet cannot be read.
    """
    return [path for name in names for path in _write(folder, content, name)]


def _write(folder: Path, content: SweepContent, name: str) -> list[Path]:
    if name == _TABLES:
        return [_copied(path, folder) for path in sorted(content.folder.glob("*.csv"))]
    file, to_bytes = _WRITERS[name]
    recording.write_bytes_atomic(folder / file, to_bytes(content))
    return [folder / file]


def _copied(table: Path, folder: Path) -> Path:
    """Return the table in a folder; a sweep has its tables from the beginning, elsewhere they are copied."""
    target = folder / table.name
    if target.resolve() != table.resolve():
        with recording.atomic_path(target) as partial:
            shutil.copyfile(table, partial)
    return target
