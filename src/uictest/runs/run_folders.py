"""Folders of finished runs that users name."""

from __future__ import annotations

from pathlib import Path

from uictest import report
from uictest.core import document, files
from uictest.running import chunked


def holds_sweep(folder: Path) -> bool:
    """Return whether a folder is that of a sweep, finished or not."""
    try:
        manifest = chunked.ChunkStore(folder).manifest()
    except OSError:
        return False
    return document.is_of(manifest, document.MANIFEST, "sweep")


def why_no_run(folder: Path) -> str:
    """Return why a path is no run, e.g. `there is no PATH`; empty if it looks like one."""
    if not folder.exists():
        return f"there is no {folder}"
    if not folder.is_dir():
        return f"{folder} is a file"
    if holds_sweep(folder):
        return f"{folder} holds a sweep"
    return "" if (folder / report.RESULTS).is_file() else f"{folder} holds no run: it has no {report.RESULTS}"


def run_folder(place: Path) -> Path:
    """Return the folder of a run; `latest` may be a text file that names it, where links are impossible."""
    if place.name == files.LATEST and not place.is_dir():
        return files.latest_run(place.parent) or place
    return place
