"""`latest`: which run is the newest. A symbolic link, or a text file where links are impossible."""

from __future__ import annotations

import os
from pathlib import Path

LATEST = "latest"


def point_latest(run: Path) -> None:
    """Let `latest` beside the run folder name it; it is replaced in one step. Raises OSError."""
    latest = run.parent / LATEST
    temporary = run.parent / f".{LATEST}.{os.urandom(4).hex()}.partial"
    _name_run(temporary, run.name)
    try:
        temporary.replace(latest)
    except OSError:
        temporary.unlink(missing_ok=True)
        raise


def latest_run(parent: Path) -> Path | None:
    """Return the newest run folder below `parent`, or None where there is none. Raises OSError."""
    latest = parent / LATEST
    if latest.is_file() and not latest.is_symlink():
        run = parent / latest.read_text(encoding="utf-8").strip()
    else:
        run = latest.resolve()
    return run if run.is_dir() else None


def _name_run(place: Path, name: str) -> None:
    try:
        place.symlink_to(name, target_is_directory=True)
    except (OSError, NotImplementedError):
        place.write_text(f"{name}\n", encoding="utf-8")
