"""What a folder that should hold a run holds instead."""

from __future__ import annotations

from pathlib import Path


def holds_sweep(folder: Path) -> bool:
    """Return whether a folder is that of a sweep, finished or not."""
    from uictest.sweep import Store
    from uictest.sweep.manifest import SCHEMA

    try:
        manifest = Store(folder).manifest()
    except OSError:
        return False
    return manifest is not None and manifest.get("schema") == SCHEMA


def why_no_run(folder: Path) -> str:
    """Return why a place holds no run, the place named; nothing where it seems to hold one."""
    from uictest.report import RESULTS

    if not folder.exists():
        return f"there is no {folder}"
    if not folder.is_dir():
        return f"{folder} is a file"
    if holds_sweep(folder):
        return f"{folder} holds a sweep"
    return "" if (folder / RESULTS).is_file() else f"{folder} holds no run: it has no {RESULTS}"
