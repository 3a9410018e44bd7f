"""Which files uictest writes into the folder of a run."""

from __future__ import annotations

import os
from collections.abc import Iterator
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Final

_OWN: Final = (
    *("manifest.json", "results.json", "index-entry.json", "index.html", "report.xlsx", "summary.md"),
    *("junit.xml", "junit-properties.xml", "summary.csv", "wheelsets.csv", "criteria.csv", "repeats.csv"),
    *("requirements.csv", "series.csv", "series-criteria.csv", "series-stops.csv", "recordings/*.parquet"),
    *(".lock", ".partial-*"),
)
"""Patterns of their paths below the folder."""


def foreign_file(folder: Path) -> str:
    """Return the path of something in the folder that uictest did not write; empty where there is nothing.

    Links and empty folders count as foreign, too. Raises OSError.
    """
    return next((path for path in _paths(folder) if not _is_own(folder, path)), "")


def _is_own(folder: Path, path: str) -> bool:
    return not (folder / path).is_symlink() and any(
        fnmatchcase(path, pattern) and path.count("/") == pattern.count("/") for pattern in _OWN
    )


def _paths(folder: Path) -> Iterator[str]:
    """Yield the path of every file below a folder, and of every link and empty folder."""

    def fail(error: OSError) -> None:
        raise error

    for place, folders, files in os.walk(folder, onerror=fail):
        below = Path(place).relative_to(folder)
        links = [name for name in folders if (Path(place) / name).is_symlink()]
        yield from ((below / name).as_posix() for name in sorted((*files, *links)))
        if not (files or folders) and below.parts not in ((), ("recordings",)):
            yield below.as_posix()
