"""Locks of folders: one process works in a folder at a time.

The operating system holds the lock and releases it when the process ends, so that neither reused process ids
nor clocks matter. It works between machines if the network share supports such locks. Without such support
every lock is granted, and no folder counts as abandoned.
"""

from __future__ import annotations

import errno
import os
import platform
import secrets
import stat
import time
from contextlib import ExitStack, suppress
from io import FileIO
from pathlib import Path
from typing import Final, Self

from uictest.core.files.listing import path_below

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
        self._place = path_below(folder, below)
        self._path = self._place / (_SHARED.replace("*", secrets.token_hex(8)) if shared else LOCK)
        latest = time.monotonic() + patience
        while True:
            try:
                self._file = _locked(self._path, make=not abandoned)
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
            _release(self._file, self._path, leave=self.leaves_file)

    def _require_only(self, *, shared: bool) -> None:
        """Write who holds the lock, and release it where another process holds one that excludes it."""
        holder = "another shard" if shared else f"process {os.getpid()} on {platform.node()}"
        try:
            with suppress(OSError):  # a full disk: nobody learns the name
                self._file.truncate(self._file.seek(0))
                self._file.write(_MARK + holder.encode())
            # Whoever comes at the same time looks for this one after taking its own: one of the two sees it.
            for other in [self._place / LOCK] if shared else self._place.glob(_SHARED):
                with suppress(FileNotFoundError, FileExistsError):  # it is free, or no lock
                    _release(_locked(other, make=False), other)
        except BaseException:
            self.release()
            raise


def _locked(path: Path, *, make: bool) -> FileIO:
    """Return the open file of a lock that is held now; `make` makes a missing one.

    Raises FolderInUseError, OSError.
    """
    while True:
        with ExitStack() as attempt:
            file = attempt.enter_context(_opened(path, make=make))
            granted = _granted(file)
            if not granted and not make:
                raise FileNotFoundError(errno.ENOENT, "there are no locks here", str(path))
            if granted and not _is_at(path, file):
                continue  # its last holder has just removed it
            status = os.fstat(file.fileno())
            if status.st_nlink > 1 or not (_named(file) or (make and not status.st_size)):
                raise _no_lock(path)
            attempt.pop_all()
            return file


def _opened(path: Path, *, make: bool) -> FileIO:
    with suppress(FileNotFoundError):
        if not stat.S_ISREG(path.lstat().st_mode):
            raise _no_lock(path)
    return path.open("a+b" if make else "r+b", buffering=0)


def _no_lock(path: Path) -> FileExistsError:
    said = "is no lock of uictest and stays as it is: remove it, or use another folder"
    return FileExistsError(errno.EEXIST, said, str(path))


def _named(file: FileIO) -> bytes:
    """Return who holds a lock as its file says, with the mark; nothing where it is none of uictest."""
    file.seek(1)  # nobody else can read the first byte of a locked file of Windows
    content = _MARK[:1] + file.read(_LONGEST)
    return content if content.startswith(_MARK) else b""


def _granted(file: FileIO) -> bool:
    """Lock an open file; return False where there are no locks. Raises FolderInUseError."""
    from filelock import lock_descriptor

    try:
        if lock_descriptor(file.fileno(), blocking=False):
            return True
    except OSError:
        return False
    holder = _named(file).removeprefix(_MARK).decode("utf-8", "replace")
    raise FolderInUseError(holder or "another process")


def _is_at(path: Path, file: FileIO) -> bool:
    """Return whether an open file still has this path. Raises OSError."""
    try:
        return os.path.samestat(path.lstat(), os.fstat(file.fileno()))
    except FileNotFoundError:
        return False


def _release(file: FileIO, path: Path, *, leave: bool = False) -> None:
    """Release a lock; its file is removed, unless it is to stay or is no longer that of this path."""
    with file, suppress(OSError):
        if not leave and _is_at(path, file):
            file.truncate(0)  # whoever opens it before it is removed finds no abandoned lock
            path.unlink()
        return
    with suppress(OSError):  # Windows removes a file after it is closed, unless another process has opened it
        path.unlink()
