"""Folders that are open: what is named below one stays below it."""

from __future__ import annotations

import errno
import os
import re
import secrets
import stat
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path, PurePath
from typing import Final

_FOLDER: Final = os.O_RDONLY | os.O_DIRECTORY
# A FIFO must not block until somebody writes.
_FILE: Final = os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK
_PARTIAL: Final = re.compile(r"\.uictest-[0-9a-f]{16}\.partial")


@contextmanager
def opened(folder: Path, below: str = "", *, make: bool = False) -> Iterator[int]:
    """Lend the descriptor of a folder.

    Args:
        folder: as the user named it; it may be a link.
        below: path of a folder below it, of names that are no links; empty for the folder itself.
        make: whether missing folders of `below` are made.

    Raises OSError.
    """
    place = os.open(folder, _FOLDER)
    try:
        for name in PurePath(below).parts:
            if make:
                with suppress(FileExistsError):
                    os.mkdir(name, dir_fd=place)
            outer, place = place, _inner(place, name)
            os.close(outer)
        yield place
    finally:
        os.close(place)


def _inner(place: int, name: str) -> int:
    if name in ("..", "/"):
        raise OSError(errno.EINVAL, "leads out of its folder", name)
    try:
        return os.open(name, _FOLDER | os.O_NOFOLLOW, dir_fd=place)
    except OSError as error:
        if is_link(place, name):
            raise OSError(errno.ELOOP, "is a link, which is not followed", name) from error
        raise


def is_link(place: int, name: str) -> bool:
    """Return whether a name in an open folder is a link."""
    with suppress(OSError):
        return stat.S_ISLNK(os.stat(name, dir_fd=place, follow_symlinks=False).st_mode)
    return False


def names_in(place: int) -> list[str]:
    """Return what an open folder holds. Raises OSError."""
    with os.scandir(place) as entries:
        return [entry.name for entry in entries]


def exists(place: int, name: str) -> bool:
    """Return whether there is anything of this name in an open folder, be it a link that leads nowhere."""
    try:
        os.stat(name, dir_fd=place, follow_symlinks=False)
    except FileNotFoundError:
        return False
    return True


def is_at(place: int, name: str, descriptor: int) -> bool:
    """Return whether an open file still has this name in an open folder."""
    try:
        there = os.stat(name, dir_fd=place, follow_symlinks=False)
    except FileNotFoundError:
        return False
    return os.path.samestat(there, os.fstat(descriptor))


@contextmanager
def opened_file(place: int, name: str, flags: int = _FILE) -> Iterator[int]:
    """Lend the descriptor of a regular file in an open folder. Raises OSError, also for anything else."""
    descriptor = os.open(name, flags | os.O_NOFOLLOW, 0o666, dir_fd=place)
    try:
        if not stat.S_ISREG(os.fstat(descriptor).st_mode):
            raise OSError(errno.EINVAL, "is no regular file", name)
        yield descriptor
    finally:
        os.close(descriptor)


def partial_name() -> str:
    """Return a name that nothing has, for what gets its own name when it is complete."""
    return f".uictest-{secrets.token_hex(8)}.partial"


def is_partial(place: int, name: str) -> bool:
    """Return whether a name in an open folder is that of an unfinished file."""
    if _PARTIAL.fullmatch(name) is None:
        return False
    return not stat.S_ISDIR(os.stat(name, dir_fd=place, follow_symlinks=False).st_mode)
