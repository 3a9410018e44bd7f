"""Where the recording of a case lies: the one place where the id of a case becomes the name of a file."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path, PurePosixPath, PureWindowsPath
from typing import Final

RECORDINGS: Final = "recordings"
_ELSEWHERE: Final = ("", ".", "..")


def recording_path(folder: Path, case_id: str) -> Path:
    """Return the path of the recording of a case below the folder of a run.

    Raises ValueError for an id that would lead out of the folder, on any system.
    """
    require_names([case_id])
    return folder / RECORDINGS / f"{case_id}.parquet"


def require_names(case_ids: Iterable[str]) -> None:
    """Raise ValueError for an id that is not the name of a file: a path, on this system or another."""
    for case_id in case_ids:
        if not _is_name(case_id):
            raise ValueError(f"the id {case_id!r} of a case is not the name of a file")


def _is_name(case_id: str) -> bool:
    names = {path(case_id).name for path in (PurePosixPath, PureWindowsPath)}
    return case_id not in _ELSEWHERE and names == {case_id} and "\0" not in case_id
