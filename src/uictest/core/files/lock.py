"""Locks of folders: one process works in a folder at a time.

The operating system holds the lock (`flock`) and releases it when the process ends, so that neither reused
process ids nor clocks matter. It works between machines if the network share supports such locks. Without
such support every lock is granted, and no folder counts as abandoned.
"""

from __future__ import annotations

import errno
import fcntl
import os
import time
from contextlib import ExitStack, suppress
from pathlib import Path
from types import TracebackType
from typing import Final, Self

from uictest.core.files.listing import is_at, opened, opened_file

LOCK: Final = ".uictest.lock"
_MARK: Final = b"uictest lock: "
"""How the file of a lock begins; an empty one is being made."""
_LONGEST: Final = 500
_PAUSE: Final = 0.05
"""Between two attempts, s."""


class FolderInUseError(Exception):
    """Another process holds the lock of the folder; the message names it."""


class FolderLock:
    """The lock of a folder, held from its construction to the end of the block.

    Args:
        folder: an existing folder; it may be a link.
        below: path of a folder below it, through no link; empty for the folder itself.
        name: of the file of the lock, which stands in the folder while the lock is held.
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
        name: str = LOCK,
        shared: bool = False,
        abandoned: bool = False,
        patience: float = 0.0,
    ) -> None:
        self._name, self._shared, self._abandoned = name, shared, abandoned
        self.leaves_file = shared
        """Whether the file stays at the release: others may hold it, or it marks an abandoned folder."""
        with ExitStack() as held:
            self.place = held.enter_context(opened(folder, below))
            """Descriptor of the folder."""
            latest = time.monotonic() + patience
            while True:
                try:
                    if self._acquired(held, folder / below / name):
                        break
                except FolderInUseError:
                    if time.monotonic() >= latest:
                        raise
                    time.sleep(_PAUSE)
            self._held = held.pop_all()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.release()

    def release(self) -> None:
        """Release the lock; its file is removed, unless it is to stay."""
        if not self.leaves_file and is_at(self.place, self._name, self._descriptor):
            with suppress(OSError):
                os.unlink(self._name, dir_fd=self.place)
        self._held.close()

    def _acquired(self, held: ExitStack, path: Path) -> bool:
        """Return whether the lock is held now, False where its last holder has just removed the file."""
        flags = os.O_RDWR | os.O_NONBLOCK | (0 if self._abandoned else os.O_CREAT)
        with ExitStack() as attempt:
            try:
                self._descriptor = attempt.enter_context(opened_file(self.place, self._name, flags))
                content = os.pread(self._descriptor, _LONGEST, 0)
                own = content.startswith(_MARK) or not (content or self._abandoned)
                if not own or os.fstat(self._descriptor).st_nlink > 1:
                    raise OSError(errno.EINVAL, "is no lock", self._name)
            except OSError as error:
                if error.errno not in (errno.EINVAL, errno.ELOOP, errno.EISDIR, errno.EMLINK):
                    raise
                said = "is no lock of uictest and stays as it is: remove it, or use another folder"
                raise FileExistsError(errno.EEXIST, said, str(path)) from error
            granted = self._granted()
            if granted and not is_at(self.place, self._name, self._descriptor):
                return False
            if not granted and self._abandoned:
                raise FileNotFoundError(errno.ENOENT, "there are no locks here", str(path))
            if granted:
                self._name_holder()
            held.enter_context(attempt.pop_all())
        return True

    def _granted(self) -> bool:
        """Lock the open file; return False where there are no locks. Raises FolderInUseError."""
        try:
            fcntl.flock(self._descriptor, (fcntl.LOCK_SH if self._shared else fcntl.LOCK_EX) | fcntl.LOCK_NB)
        except BlockingIOError as error:
            holder = os.pread(self._descriptor, _LONGEST, 0).removeprefix(_MARK).decode("utf-8", "replace")
            raise FolderInUseError(holder or "another process") from error
        except OSError:
            return False
        return True

    def _name_holder(self) -> None:
        holder = "another shard" if self._shared else f"process {os.getpid()} on {os.uname().nodename}"
        content = _MARK + holder.encode()
        with suppress(OSError):  # a full disk: nobody learns the name
            os.pwrite(self._descriptor, content, 0)
            os.truncate(self._descriptor, len(content))
