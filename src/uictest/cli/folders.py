"""What a folder that should hold a run holds instead."""

from __future__ import annotations

import json
from pathlib import Path

_SWEEP = "uictest/sweep-manifest/"
_MANIFEST = "manifest.json"


def holds_sweep(folder: Path) -> bool:
    """Return whether a folder is that of a sweep, finished or not."""
    try:
        manifest = json.loads((folder / _MANIFEST).read_bytes())
    except (OSError, ValueError):
        return False
    return isinstance(manifest, dict) and str(manifest.get("schema")).startswith(_SWEEP)


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
