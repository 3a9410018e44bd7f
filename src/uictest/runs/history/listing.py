"""Everything that stands in a folder of runs, newest first, read within bounds."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Final, NamedTuple

from uictest.core import files
from uictest.runs.history.run_in_folder import ListedRun, Unlisted, read_folder

FOLDERS_READ: Final = 500
"""Folders that are read, the newest ones by their time of change."""


class Listing(NamedTuple):
    """What stands in a folder of runs.

    Args:
        runs: finished runs, newest first.
        unlisted: the other folders, by name.
        not_read: number of older folders that were not read.
        partial: number of folders that are being filled, or that a killed run left.

    """

    runs: Sequence[ListedRun]
    unlisted: Sequence[Unlisted]
    not_read: int = 0
    partial: int = 0


def list_runs(parent: Path) -> Listing:
    """Return what stands in a folder of runs. Raises OSError where the folder itself cannot be read."""
    folders = sorted(_folders(parent), key=_changed, reverse=True)
    hidden = [folder for folder in folders if folder.name.startswith(".")]
    visible = [folder for folder in folders if folder not in set(hidden)]
    read = [read_folder(folder) for folder in visible[:FOLDERS_READ]]
    listed = [each for each in read if isinstance(each, ListedRun)]
    return Listing(
        runs=sorted(listed, key=lambda run: (run.started, run.order, run.name), reverse=True),
        unlisted=sorted((each for each in read if isinstance(each, Unlisted)), key=lambda each: each.name),
        not_read=len(visible[FOLDERS_READ:]),
        partial=sum(folder.name.endswith(".partial") for folder in hidden),
    )


def _folders(parent: Path) -> list[Path]:
    return [each for each in parent.iterdir() if each.name != files.LATEST and each.is_dir()]


def _changed(folder: Path) -> tuple[float, str]:
    try:
        return folder.stat().st_mtime, folder.name
    except OSError:
        return 0.0, folder.name
