"""The right of one process to work in a folder; it ends with the process, however that ends.

The system gives and takes it (`flock`), so neither a number of a process that is used again nor a clock
matters. It holds between machines where the network share knows such locks. Where it does not, and on
Windows, nobody is refused and nothing is taken for abandoned.
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
    """Another process works in the folder; the message names it."""


class FolderLock:
    """The right to work in a folder, from here to the end of the block.

    Args:
        folder: an existing folder.
        shared: whether others that share it may work there at the same time.

    Raises:
        FolderInUseError: another process has it.
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
        """Remove the file of the lock, which stays held."""
        with contextlib.suppress(OSError):
            self._path.unlink()

    def release(self) -> None:
        """Give the right back."""
        if not self._shared:
            self.hide()
        os.close(self._descriptor)


def remove_abandoned(folder: Path) -> None:
    """Remove a folder whose lock is that of a process that has ended; leave any other as it is."""
    with contextlib.suppress(OSError), (folder / _FILE).open("r+b") as file:
        # Whoever has the lock has written its name; before, the folder is only just being made.
        if file.read(1) and _lock(file.fileno(), shared=False):
            shutil.rmtree(folder, ignore_errors=True)


def _locked(path: Path, shared: bool) -> int:
    """Return a descriptor of the file of a lock that is held."""
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
