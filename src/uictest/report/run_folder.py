"""The folder of one run: filled under a temporary name, renamed when it is complete.

The next run removes what a killed run left under such a name. `latest` next to the folders names the newest:
a symbolic link, or a text file where links are impossible.
"""

from __future__ import annotations

import contextlib
import itertools
import os
import shutil
from pathlib import Path
from types import TracebackType
from typing import Self

from uictest.folder_lock import FolderLock, remove_abandoned

LATEST = "latest"


class RunFolder:
    """A folder that appears as `parent/name` when it is published, and otherwise not at all.

    Use it as a context manager: leaving the block without `publish` removes everything that was created,
    including parents. A name that is taken gets `-2`, `-3`, ... at its end.

    Args:
        parent: the folder of all runs; made if it is missing.
        name: the name of the run.

    Raises:
        OSError: the folder cannot be made.
    """

    def __init__(self, parent: Path, name: str) -> None:
        self._parent = parent
        self._wanted = name
        self._published = False
        self._made_parents = _make_missing(parent)
        _remove_abandoned(parent)
        self._name = _free_name(parent, name)
        self.path = parent / f".{self._name}.{os.urandom(4).hex()}.partial"
        try:
            self.path.mkdir()
            self._lock = FolderLock(self.path)
        except OSError:
            shutil.rmtree(self.path, ignore_errors=True)
            self._remove_made_parents()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if not self._published:
            shutil.rmtree(self.path, ignore_errors=True)
            self._remove_made_parents()
        self._lock.release()

    @property
    def name(self) -> str:
        """The name that the folder gets, which its reports state."""
        return self._name

    def publish(self) -> Path:
        """Give the folder its name, and return where it stands now. Raises OSError."""
        self._lock.hide()
        if (self._parent / self._name).exists():  # somebody made it meanwhile
            self._name = _free_name(self._parent, self._wanted)
        self.path = self.path.rename(self._parent / self._name)
        self._published = True
        return self.path

    def _remove_made_parents(self) -> None:
        # Innermost first. A folder that contains other files by now is kept, and so are its parents.
        with contextlib.suppress(OSError):
            for folder in reversed(self._made_parents):
                folder.rmdir()


def _free_name(parent: Path, name: str) -> str:
    """Return the first of `name`, `name-2`, ... that no folder has, nor one that is being filled."""
    names = (name if number == 1 else f"{name}-{number}" for number in itertools.count(1))
    return next(
        each for each in names if not (parent / each).exists() and not any(parent.glob(f".{each}.*.partial"))
    )


def _remove_abandoned(parent: Path) -> None:
    for folder in parent.glob(".*.partial"):
        if not folder.is_symlink():
            remove_abandoned(folder)


def _make_missing(folder: Path) -> list[Path]:
    missing = [place for place in (folder, *folder.parents) if not place.exists()]
    folder.mkdir(parents=True, exist_ok=True)
    return list(reversed(missing))


def point_latest(run: Path) -> None:
    """Let `latest`, next to the run folder, name it; it is replaced atomically. Raises OSError."""
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
