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
    exists,
    foreign_paths,
    is_link,
    names_in,
    opened,
    opened_file,
    partial_name,
    remove_contents,
)
from uictest.core.files.lock import LOCK, FolderInUseError, FolderLock
from uictest.core.files.writing import WriteError, make_folder, remove_empty, writing

LATEST: Final = "latest"
_LONGEST_NAME: Final = 255
"""Of a file, bytes."""
_NEW: Final = os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW


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
        self._published = False
        self._made_parents = make_folder(parent)
        with writing(parent), ExitStack() as held:
            held.callback(self._remove_made_parents)
            self._place = held.enter_context(opened(parent))
            _remove_abandoned(parent, self._place)
            self._name = _reserved(self._place, name)
            self._hidden = _hidden(self._name)
            self.path = parent / self._hidden
            held.callback(self._remove_hidden)
            self._lock = held.enter_context(FolderLock(parent, self._hidden))
            held.callback(self._remove_contents)
            begin_list(self.path)
            self._held = held.pop_all()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if isinstance(error, WriteError) and Path(error.filename).is_relative_to(self.path):
            inside = Path(error.filename).relative_to(self.path)
            error.filename = str(self._parent / self._wanted / inside)  # nobody knows the hidden name
        self._held.close()

    @property
    def name(self) -> str:
        """The name that the folder gets, which its reports state."""
        return self._name

    def publish(self, name: str = "") -> Path:
        """Give the folder its name, or another one, and return where it stands now. Raises WriteError."""
        names = itertools.chain(
            [name or self._name], _names(self._wanted)
        )  # somebody may have taken it meanwhile
        with writing(self._parent / self._name):
            self._name = next(name for name in names if _renamed(self._place, self._hidden, name))
        self._published = True
        self.path = self._parent / self._name
        return self.path

    def _remove_contents(self) -> None:
        if not self._published and (stay := remove_contents(self._lock.place, LOCK)):
            _warn(self.path, stay[0])

    def _remove_hidden(self) -> None:
        if not self._published:
            with suppress(OSError):  # it holds something of the user's
                os.rmdir(self._hidden, dir_fd=self._place)

    def _remove_made_parents(self) -> None:
        if not self._published:
            remove_empty(self._made_parents)


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
    with opened(parent) as place, FolderLock(parent, name) as lock:
        if foreign := next(foreign_paths(lock.place, LOCK), ""):
            raise ForeignFileError(foreign)
        if not _renamed(place, name, hidden := _hidden(name)):
            raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), hidden)
        lock.leaves_file = True  # should this be cut short
        replace()
        if stay := remove_contents(lock.place, LOCK):
            lock.leaves_file = not _renamed(place, hidden, name)
            raise ForeignFileError(stay[0])
        os.rmdir(hidden, dir_fd=place)


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
    with writing(named), suppress(FileNotFoundError), opened(folder) as place:
        foreign = [*foreign_paths(place, LOCK)] if names_in(place) else []
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


def _remove_abandoned(parent: Path, place: int) -> None:
    """Remove what killed processes left: folders with an unlocked lock of uictest, and listed files alone."""
    for name in names_in(place):
        if not (name.startswith(".") and name.endswith(".partial")):
            continue
        with suppress(OSError, FolderInUseError), FolderLock(parent, name, abandoned=True) as lock:
            if stay := remove_contents(lock.place, LOCK):
                _warn(parent / name, stay[0])
            else:
                os.rmdir(name, dir_fd=place)


def _warn(folder: Path, name: str) -> None:
    text = "uictest: %s stays: it holds %s, which uictest did not write"
    logging.getLogger(__name__).warning(text, folder, name)


def _hidden(name: str) -> str:
    return f".{name}.partial"


def _names(name: str) -> Iterator[str]:
    yield name
    yield from (f"{name}-{number}" for number in itertools.count(2))


def _reserved(place: int, name: str) -> str:
    """Return the first name that no folder has, after its hidden folder was made: no other run has that."""
    for each in _names(name):
        if exists(place, each):
            continue
        try:
            os.mkdir(_hidden(each), dir_fd=place)
        except FileExistsError:
            continue
        if not exists(place, each):
            return each
        os.rmdir(_hidden(each), dir_fd=place)  # another run was published meanwhile
    raise AssertionError  # there are always more names


def _renamed(place: int, old: str, new: str) -> bool:
    """Rename a folder; return False, and replace nothing, where the new name is taken. Raises OSError.

    An empty folder of the new name comes first: nobody else can make it, and only a folder that is still
    empty is replaced by a rename.
    """
    try:
        os.mkdir(new, dir_fd=place)
    except FileExistsError:
        return False
    try:
        os.rename(old, new, src_dir_fd=place, dst_dir_fd=place)
    except OSError:
        try:
            os.rmdir(new, dir_fd=place)
        except OSError:
            return False  # somebody put something into it
        # File systems that replace no empty folder exist; they replace none by this either.
        os.rename(old, new, src_dir_fd=place, dst_dir_fd=place)
    return True


def point_latest(run: Path) -> str:
    """Let `latest`, next to the run folder, name it; it is replaced atomically.

    Returns why it was left as it is: somebody else's file has this name; else nothing. Raises WriteError.
    """
    with writing(run.parent / LATEST), opened(run.parent) as place:
        if exists(place, LATEST) and not is_link(place, LATEST) and not _named_in_text(place):
            return f"{run.parent / LATEST} was not written by uictest: it is left as it is"
        temporary = partial_name()
        try:
            os.symlink(run.name, temporary, target_is_directory=True, dir_fd=place)
        except (OSError, NotImplementedError):
            with os.fdopen(os.open(temporary, _NEW, 0o666, dir_fd=place), "wb") as file:
                file.write(os.fsencode(run.name) + b"\n")
        try:
            os.replace(temporary, LATEST, src_dir_fd=place, dst_dir_fd=place)
        except OSError:
            os.unlink(temporary, dir_fd=place)
            raise
    return ""


def _named_in_text(place: int) -> str:
    """Return the name in a text file `latest`; empty where it holds anything but the name of a run."""
    with suppress(OSError), opened_file(place, LATEST) as file:
        name, end, rest = os.read(file, _LONGEST_NAME + 2).partition(b"\n")
        one = end and not rest and b"/" not in name and b"\0" not in name
        return os.fsdecode(name) if one and exists(place, os.fsdecode(name)) else ""
    return ""


def latest_run(parent: Path) -> Path | None:
    """Return the newest run folder below `parent`, or None where there is none. Raises OSError."""
    latest = parent / LATEST
    if latest.is_file() and not latest.is_symlink():
        run = parent / latest.read_text(encoding="utf-8").strip()
    else:
        run = latest.resolve()
    return run if run.is_dir() else None
