"""Locks of folders: one process works in a folder at a time.

The operating system holds the lock (`flock`) and releases it when the process ends, so that neither reused
process ids nor clocks matter. It works between machines if the network share supports such locks. Without
such support, and on Windows, every lock is granted and no folder counts as abandoned.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import sys
from pathlib import Path
from types import TracebackType
from typing import Self

_FILE = ".lock"


class FolderInUseError(Exception):
    """Another process holds the lock of the folder; the message names it."""


class FolderLock:
    """The lock of a folder, held from its construction to the end of the block.

    Args:
        folder: an existing folder.
        shared: whether other shared locks may be held at the same time.

    Raises:
        FolderInUseError: another process holds the lock.
        OSError: the folder cannot be written.
    """

    def __init__(self, folder: Path, *, shared: bool = False) -> None:
        self._path = folder / _FILE
        self._shared = shared
        self._descriptor = _locked(self._path, shared)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.release()

    def hide(self) -> None:
        """Remove the file of the lock; the lock stays held."""
        with contextlib.suppress(OSError):
            self._path.unlink()

    def release(self) -> None:
        """Release the lock."""
        if not self._shared:
            self.hide()
        os.close(self._descriptor)


def remove_abandoned(folder: Path) -> None:
    """Remove a folder whose lock belongs to an ended process; do nothing otherwise."""
    with contextlib.suppress(OSError), (folder / _FILE).open("r+b") as file:
        # A holder writes its name; without one the folder is being created.
        if file.read(1) and _lock(file.fileno(), shared=False):
            shutil.rmtree(folder, ignore_errors=True)


def _locked(path: Path, shared: bool) -> int:
    """Return the descriptor of the file of an acquired lock."""
    while True:
        descriptor = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
        try:
            if not _lock(descriptor, shared):
                return descriptor
        except BlockingIOError as error:
            holder = os.read(descriptor, 500).decode("utf-8", "replace")
            os.close(descriptor)
            raise FolderInUseError(holder or "another process") from error
        if _is_at(path, descriptor):
            _name_holder(descriptor, shared)
            return descriptor
        os.close(descriptor)  # its last holder has just removed it


def _is_at(path: Path, descriptor: int) -> bool:
    try:
        return os.path.samestat(path.stat(), os.fstat(descriptor))
    except FileNotFoundError:
        return False


def _name_holder(descriptor: int, shared: bool) -> None:
    holder = "another shard" if shared else f"process {os.getpid()} on {os.uname().nodename}"
    with contextlib.suppress(OSError):  # a full disk: nobody learns the name
        os.truncate(descriptor, 0)
        os.write(descriptor, holder.encode())


if sys.platform == "win32":

    def _lock(descriptor: int, shared: bool) -> bool:
        return False

else:
    import fcntl

    def _lock(descriptor: int, shared: bool) -> bool:
        """Lock an open file; return False where there are no locks. Raises BlockingIOError."""
        operation = fcntl.LOCK_SH if shared else fcntl.LOCK_EX
        try:
            fcntl.flock(descriptor, operation | fcntl.LOCK_NB)
        except BlockingIOError:
            raise
        except OSError:
            return False
        return True
