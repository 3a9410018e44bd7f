"""The folder of one run, and locks of folders: one process works in a folder at a time.

A run folder is filled under a hidden name, and renamed when it is complete. The next run removes what a
killed run left under such a name. `latest` next to the folders names the newest: a symbolic link, or a text
file where links are impossible.

The operating system holds the lock and releases it when the process ends, so that neither reused process ids
nor clocks matter. It works between machines if the network share supports such locks. Without such support
every lock is granted, and no folder counts as abandoned.
"""

from __future__ import annotations

import errno
import itertools
import logging
import os
import platform
import secrets
import stat
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from io import FileIO
from pathlib import Path
from types import TracebackType
from typing import Final, Self

from uictest.core.files.writing import (
    LIST,
    WriteError,
    begin_list,
    foreign_paths,
    is_file,
    make_folder,
    partial_name,
    path_below,
    remove_contents,
    remove_empty,
    writing,
)

LOCK: Final = ".uictest.lock"
_SHARED: Final = ".uictest-*.lock"
"""Files of shared locks: each holder has one of its own, as systems without shared locks exist."""
_MARK: Final = b"uictest lock: "
"""How the file of a lock begins; an empty one is being made."""
_LONGEST: Final = 500
_PAUSE: Final = 0.05
"""Between two attempts, s; chosen."""


class FolderInUseError(Exception):
    """Another process holds the lock of the folder; the message names it."""


class FolderLock:
    """The lock of a folder, held from its construction to the end of the block.

    Windows renames no folder and removes no file in which a lock is held.

    Args:
        folder: an existing folder; it may be a link.
        below: path of a folder below it, through no link; empty for the folder itself.
        shared: whether other shared locks may be held at the same time.
        abandoned: whether only the lock is wanted that a process left which has ended.
        patience: how long to wait for another process, s.

    Raises:
        FolderInUseError: another process holds the lock.
        OSError: the folder cannot be written, or a file of this name is not of uictest: it stays as it is.
            FileNotFoundError: there is no abandoned lock.
    """

    def __init__(
        self,
        folder: Path,
        below: str = "",
        *,
        shared: bool = False,
        abandoned: bool = False,
        patience: float = 0.0,
    ) -> None:
        self.leaves_file = False
        """Whether the file stays at the release: it marks an abandoned folder."""
        self._folder = path_below(folder, below)
        self._path = self._folder / (_SHARED.replace("*", secrets.token_hex(8)) if shared else LOCK)
        latest = time.monotonic() + patience
        while True:
            try:
                self._file = _acquire_lock_file(self._path, make=not abandoned)
                self._require_only(shared=shared)
                break
            except FolderInUseError:
                if time.monotonic() >= latest:
                    raise
                time.sleep(_PAUSE)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self.release()

    def release(self) -> None:
        """Release the lock, once; its file is removed, unless it is to stay."""
        if not self._file.closed:
            _release_lock_file(self._file, self._path, leave=self.leaves_file)

    def _require_only(self, *, shared: bool) -> None:
        """Write who holds the lock, and release it where another process holds one that excludes it."""
        holder = "another shard" if shared else f"process {os.getpid()} on {platform.node()}"
        try:
            with suppress(OSError):  # a full disk: nobody learns the name
                self._file.truncate(self._file.seek(0))
                self._file.write(_MARK + holder.encode())
            # Whoever comes at the same time looks for this one after taking its own: one of the two sees it.
            for other in [self._folder / LOCK] if shared else self._folder.glob(_SHARED):
                with suppress(FileNotFoundError, FileExistsError):  # it is free, or no lock
                    _release_lock_file(_acquire_lock_file(other, make=False), other)
        except BaseException:
            self.release()
            raise


def _acquire_lock_file(path: Path, *, make: bool) -> FileIO:
    """Return the open file of a lock that is held now; `make` makes a missing one.

    Raises FolderInUseError, OSError.
    """
    while True:
        with ExitStack() as attempt:
            file = attempt.enter_context(_open_lock_file(path, make=make))
            granted = _try_lock(file)
            if not granted and not make:
                raise FileNotFoundError(errno.ENOENT, "there are no locks here", str(path))
            if granted and not _is_at(path, file):
                continue  # its last holder has just removed it
            status = os.fstat(file.fileno())
            if status.st_nlink > 1 or not (_read_holder(file) or (make and not status.st_size)):
                raise _not_a_lock_error(path)
            attempt.pop_all()
            return file


def _open_lock_file(path: Path, *, make: bool) -> FileIO:
    with suppress(FileNotFoundError):
        if not stat.S_ISREG(path.lstat().st_mode):
            raise _not_a_lock_error(path)
    return path.open("a+b" if make else "r+b", buffering=0)


def _not_a_lock_error(path: Path) -> FileExistsError:
    text = "is no lock of uictest and stays as it is: remove it, or use another folder"
    return FileExistsError(errno.EEXIST, text, str(path))


def _read_holder(file: FileIO) -> bytes:
    """Return the mark and the holder that a lock file states; empty if it is not a lock of uictest."""
    file.seek(1)  # nobody else can read the first byte of a locked file of Windows
    content = _MARK[:1] + file.read(_LONGEST)
    return content if content.startswith(_MARK) else b""


def _try_lock(file: FileIO) -> bool:
    """Lock an open file; return False where there are no locks. Raises FolderInUseError."""
    from filelock import lock_descriptor

    try:
        if lock_descriptor(file.fileno(), blocking=False):
            return True
    except OSError:
        return False
    holder = _read_holder(file).removeprefix(_MARK).decode("utf-8", "replace")
    raise FolderInUseError(holder or "another process")


def _is_at(path: Path, file: FileIO) -> bool:
    try:
        return os.path.samestat(path.lstat(), os.fstat(file.fileno()))
    except FileNotFoundError:
        return False


def _release_lock_file(file: FileIO, path: Path, *, leave: bool = False) -> None:
    """Release a lock; its file is removed, unless it is to stay or is no longer that of this path."""
    with file, suppress(OSError):
        if not leave and _is_at(path, file):
            file.truncate(0)  # whoever opens it before it is removed finds no abandoned lock
            path.unlink()
        return
    with suppress(OSError):  # Windows removes a file after it is closed, unless another process has opened it
        path.unlink()


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
            self._name = _reserve_name(parent, name)
            self.path = _hidden_folder_of(parent / self._name)
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
        names = itertools.chain([name or self._name], _candidate_names(self._wanted))
        self._lock.release()  # Windows renames no folder with an open file
        with writing(self._parent / self._name):
            self._name = next(name for name in names if _rename_unless_taken(self.path, self._parent / name))
        self._undo.pop_all()
        self.path = self._parent / self._name
        return self.path

    def _remove_contents(self) -> None:
        if remaining := remove_contents(self.path, LOCK):
            _warn_of_foreign(self.path, remaining[0])


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
    folder, hidden = parent / name, _hidden_folder_of(parent / name)
    with FolderLock(parent, name) as lock:
        if foreign := next(foreign_paths(folder, LOCK), ""):
            raise ForeignFileError(foreign)
        lock.leaves_file = not os.path.lexists(hidden)  # should this be cut short
    if not _rename_unless_taken(folder, hidden):
        raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), str(hidden))
    replace()
    if foreign := _remove_hidden_folder(hidden, abandoned=False):
        _rename_unless_taken(hidden, folder)
        raise ForeignFileError(foreign)


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
            raise ForeignFileError(next((path for path in foreign if path != LIST), LIST))
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
            if foreign := _remove_hidden_folder(folder, abandoned=True):
                _warn_of_foreign(folder, foreign)


def _remove_hidden_folder(folder: Path, *, abandoned: bool) -> str:
    """Remove a hidden folder; return the first foreign path in it. Raises OSError, FolderInUseError."""
    with FolderLock(folder.parent, folder.name, abandoned=abandoned) as lock:
        lock.leaves_file = True  # should this be cut short
        stay = remove_contents(folder, LOCK)
        lock.leaves_file = False
    if not stay:
        folder.rmdir()
    return next(iter(stay), "")


def _warn_of_foreign(folder: Path, name: str) -> None:
    text = "uictest: %s stays: it holds %s, which uictest did not write"
    logging.getLogger(__name__).warning(text, folder, name)


def _hidden_folder_of(folder: Path) -> Path:
    return folder.with_name(f".{folder.name}.partial")


def new_folder(parent: Path, name: str) -> Path:
    """Make `parent/name`, with `-2`, `-3`, ... at its end where that name is taken. Raises WriteError."""
    make_folder(parent)
    with writing(parent / name):
        for free in _candidate_names(name):
            with suppress(FileExistsError):
                (parent / free).mkdir()
                return parent / free
    raise AssertionError  # there are always more names


def _candidate_names(name: str) -> Iterator[str]:
    yield name
    yield from (f"{name}-{number}" for number in itertools.count(2))


def _reserve_name(parent: Path, name: str) -> str:
    """Return the first free name of a folder, reserved for this run by making its hidden folder."""
    for free in _candidate_names(name):
        folder = parent / free
        if os.path.lexists(folder):
            continue
        try:
            _hidden_folder_of(folder).mkdir()
        except FileExistsError:
            continue
        if not os.path.lexists(folder):
            return free
        _hidden_folder_of(folder).rmdir()  # another run was published meanwhile
    raise AssertionError  # there are always more names


def _rename_unless_taken(old: Path, new: Path) -> bool:
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
