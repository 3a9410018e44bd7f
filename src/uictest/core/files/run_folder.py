"""The folder of one run: filled under a hidden name, renamed when it is complete.

The next run removes what a killed run left under such a name. `latest` next to the folders names the newest:
a symbolic link, or a text file where links are impossible.
"""

from __future__ import annotations

import errno
import itertools
import logging
import os
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from types import TracebackType
from typing import Final, Self

from uictest.core.files.listing import (
    LIST,
    begin_list,
    foreign_paths,
    is_file,
    partial_name,
    remove_contents,
)
from uictest.core.files.lock import LOCK, FolderInUseError, FolderLock
from uictest.core.files.writing import WriteError, make_folder, remove_empty, writing

LATEST: Final = "latest"
_LONGEST_NAME: Final = 255
"""Of a file, bytes."""


class RunFolder:
    """A folder that appears as `parent/name` when it is published, and otherwise not at all.

    Use it as a context manager: leaving the block without `publish` removes everything that was written,
    including parents. A name that is taken gets `-2`, `-3`, ... at its end. Files that are written into it
    are listed.

    Args:
        parent: the folder of all runs; made if it is missing.
        name: the name of the run.

    Raises:
        WriteError: the folder cannot be made.
    """

    def __init__(self, parent: Path, name: str) -> None:
        self._parent = parent
        self._wanted = name
        with writing(parent), ExitStack() as undo:
            undo.callback(remove_empty, make_folder(parent))
            _remove_abandoned(parent)
            self._name = _reserved(parent, name)
            self.path = _hidden(parent / self._name)
            undo.callback(remove_empty, [self.path])
            self._lock = undo.enter_context(FolderLock(self.path))
            undo.callback(self._remove_contents)
            begin_list(self.path)
            self._undo = undo.pop_all()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if isinstance(error, WriteError) and Path(error.filename).is_relative_to(self.path):
            inside = Path(error.filename).relative_to(self.path)
            error.filename = str(self._parent / self._wanted / inside)  # nobody knows the hidden name
        self._undo.close()

    @property
    def name(self) -> str:
        """The name that the folder gets, which its reports state."""
        return self._name

    def publish(self, name: str = "") -> Path:
        """Give the folder its name, or another one, and return where it stands now. Raises WriteError."""
        # Somebody may have taken it meanwhile.
        names = itertools.chain([name or self._name], _names(self._wanted))
        self._lock.release()  # Windows renames no folder with an open file
        with writing(self._parent / self._name):
            self._name = next(name for name in names if _renamed(self.path, self._parent / name))
        self._undo.pop_all()
        self.path = self._parent / self._name
        return self.path

    def _remove_contents(self) -> None:
        if stay := remove_contents(self.path, LOCK):
            _warn(self.path, stay[0])


class ForeignFileError(Exception):
    """A folder holds something that uictest did not write, or that has changed; the message is its path."""


def remove_run(parent: Path, name: str, replace: Callable[[], object] = lambda: None) -> None:
    """Remove the folder of a run.

    It gets a hidden name first: should that be cut short, the next run removes the rest. `replace` puts
    another one in its place before any file of it is removed.

    Raises:
        ForeignFileError: the folder holds something else than the files of its list; all of it stays.
        FolderInUseError: another process works in the folder.
        OSError: it cannot be removed.

    """
    folder, hidden = parent / name, _hidden(parent / name)
    with FolderLock(parent, name) as lock:
        if foreign := next(foreign_paths(folder, LOCK), ""):
            raise ForeignFileError(foreign)
        lock.leaves_file = not os.path.lexists(hidden)  # should this be cut short
    if not _renamed(folder, hidden):
        raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), str(hidden))
    replace()
    if stay := _removed(hidden, abandoned=False):
        _renamed(hidden, folder)
        raise ForeignFileError(stay)


@contextmanager
def replaced_folder(folder: Path) -> Iterator[Path]:
    """Lend a folder to fill that takes the place of `folder` at once if the block succeeds.

    Files are written into it as into a run folder, and listed.

    Raises:
        ForeignFileError: `folder` holds something else than listed files as they were written; it stays.
        FolderInUseError: another process works in it.
        WriteError: it cannot be written or replaced.

    """
    named, folder = folder, Path(os.path.realpath(folder))
    with writing(named), suppress(FileNotFoundError):
        foreign = [*foreign_paths(folder, LOCK)] if any(folder.iterdir()) else []
        if foreign:  # what lies there says more than a missing list
            raise ForeignFileError(next((each for each in foreign if each != LIST), LIST))
    with RunFolder(folder.parent, folder.name) as new:
        yield new.path
        with suppress(OSError):  # it is missing, or holds something
            folder.rmdir()
        if os.path.lexists(folder):
            with writing(named):
                remove_run(folder.parent, folder.name, lambda: new.publish(folder.name))
        else:
            new.publish(folder.name)


def _remove_abandoned(parent: Path) -> None:
    """Remove what killed processes left: folders with an unlocked lock of uictest, and listed files alone."""
    for folder in [*parent.glob(".*.partial")]:
        with suppress(OSError, FolderInUseError):
            if stay := _removed(folder, abandoned=True):
                _warn(folder, stay)


def _removed(folder: Path, *, abandoned: bool) -> str:
    """Remove a hidden folder; return what it holds of somebody else. Raises OSError, FolderInUseError."""
    with FolderLock(folder.parent, folder.name, abandoned=abandoned) as lock:
        lock.leaves_file = True  # should this be cut short
        stay = remove_contents(folder, LOCK)
        lock.leaves_file = False
    if not stay:
        folder.rmdir()
    return next(iter(stay), "")


def _warn(folder: Path, name: str) -> None:
    text = "uictest: %s stays: it holds %s, which uictest did not write"
    logging.getLogger(__name__).warning(text, folder, name)


def _hidden(folder: Path) -> Path:
    return folder.with_name(f".{folder.name}.partial")


def _names(name: str) -> Iterator[str]:
    yield name
    yield from (f"{name}-{number}" for number in itertools.count(2))


def _reserved(parent: Path, name: str) -> str:
    """Return the first name that no folder has, after its hidden folder was made: no other run has that."""
    for each in _names(name):
        folder = parent / each
        if os.path.lexists(folder):
            continue
        try:
            _hidden(folder).mkdir()
        except FileExistsError:
            continue
        if not os.path.lexists(folder):
            return each
        _hidden(folder).rmdir()  # another run was published meanwhile
    raise AssertionError  # there are always more names


def _renamed(old: Path, new: Path) -> bool:
    """Rename a folder; return False, and replace nothing, where the new name is taken. Raises OSError."""
    if os.path.lexists(new):
        return False
    try:
        old.rename(new)  # replaces at most an empty folder, which has just appeared
    except OSError:
        if os.path.lexists(new):
            return False
        raise
    return True


def point_latest(run: Path) -> str:
    """Let `latest`, next to the run folder, name it; it is replaced atomically.

    Returns why it was left as it is: somebody else's file has this name; else nothing. Raises WriteError.
    """
    latest, temporary = run.parent / LATEST, run.parent / partial_name()
    with writing(latest):
        if os.path.lexists(latest) and not latest.is_symlink() and not _named_in_text(latest):
            return f"{latest} was not written by uictest: it is left as it is"
        with suppress(OSError):
            if os.name != "nt":  # Windows gives links to some users only, and replaces none
                temporary.symlink_to(run.name, target_is_directory=True)
        if not temporary.is_symlink():
            temporary.write_bytes(os.fsencode(run.name) + b"\n")
        try:
            temporary.replace(latest)
        except OSError:
            temporary.unlink()
            raise
    return ""


def _named_in_text(latest: Path) -> str:
    """Return the name in a text file `latest`; empty where it holds anything but the name of a run."""
    with suppress(OSError):
        if is_file(latest) and latest.stat().st_size < _LONGEST_NAME + 2:
            name, end, rest = latest.read_bytes().partition(b"\n")
            one = end and not rest and b"/" not in name and b"\0" not in name
            return os.fsdecode(name) if one and os.path.lexists(latest.with_name(os.fsdecode(name))) else ""
    return ""


def latest_run(parent: Path) -> Path | None:
    """Return the newest run folder below `parent`, or None where there is none. Raises OSError."""
    name = _named_in_text(parent / LATEST)
    run = parent / name if name else (parent / LATEST).resolve()
    return run if run.is_dir() else None
