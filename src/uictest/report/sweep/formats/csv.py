"""The tables of a sweep, which its own folder has from the beginning."""

from __future__ import annotations

import shutil
from pathlib import Path

from uictest.core import files
from uictest.report.sweep.folder import SweepFormat


def _copied(table: Path, folder: Path) -> Path:
    """Return the table in a folder; where it is not yet, it is copied."""
    target = folder / table.name
    if target.resolve() != table.resolve():
        with files.new_file(folder, table.name) as copy, table.open("rb") as rows:
            shutil.copyfileobj(rows, copy)
    return target


FORMAT = SweepFormat(
    lambda folder, content: [_copied(path, folder) for path in sorted(content.folder.glob("*.csv"))]
)
