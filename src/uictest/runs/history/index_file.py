"""`index.html` of a folder of runs: written after each of them."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from uictest import report
from uictest.core import files
from uictest.runs.history.entry import encodable
from uictest.runs.history.listing import list_runs
from uictest.runs.history.page import MARK, index_html

INDEX: Final = "index.html"
_PATIENCE: Final = 10.0
"""How long another process may take to write the index, s."""


def refresh_index(folder: Path) -> str:
    """Write the index of a folder of runs; return why it was not written, empty if it was.

    A page of somebody else is left alone. Processes that end at the same time write one after the other, so
    that the last index has the runs of all. Raises nothing: what the index lists is published already.
    """
    path = folder / INDEX
    try:
        if not is_own_index(path):
            return f"{path} is no index of runs: it is left as it is, and there is no list of the runs here"
        with files.FolderLock(folder, patience=_PATIENCE):
            page = index_html(folder.resolve().name or str(folder), list_runs(folder))
            files.write(folder, INDEX, encodable(page))
    except files.FolderInUseError as error:
        return f"{path} is not refreshed: {folder} is in use by {error}; the next run refreshes it"
    except OSError as error:
        about = "" if error.filename in (None, str(path), str(folder)) else f"{error.filename} "
        return f"{path} is not refreshed: {about}{error.strerror or error}"
    return ""


def is_own_index(path: Path) -> bool:
    """Return whether a file is an index, or there is none. Raises OSError."""
    return report.may_replace(path, MARK)
