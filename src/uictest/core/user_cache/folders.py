"""The folders of the cache, and checks that only this user can write or replace them."""

from __future__ import annotations

import contextlib
import os
import stat
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from uictest.core import files

_BY_OTHERS = stat.S_IWGRP | stat.S_IWOTH
_SYSTEM = 0
"""User id of the system's administrator."""


def roots() -> Iterator[Path]:
    """Yield the folders of the cache, the best first; they need not exist."""
    with contextlib.suppress(RuntimeError):  # a user without a home
        yield _user_cache().absolute()
    user = os.getuid() if hasattr(os, "getuid") else os.environ.get("USERNAME", "user")
    with contextlib.suppress(FileNotFoundError):  # no temporary folder is writable
        yield Path(tempfile.gettempdir(), f"uictest-{user}").absolute()


def make_private(folder: Path) -> None:
    """Create a folder and its missing parents for this user alone. Raises OSError."""
    files.make_folder(folder, mode=0o700)


def why_unsafe(folder: Path) -> str:
    """Return why others could put files into an existing folder, and what to do; empty if they cannot.

    The folder must belong to this user, and every folder above it to this user or the system: whoever can
    write a folder can rename its contents, unless it is sticky, like /tmp. The target of a link is checked
    as well. Raises OSError.
    """
    if not hasattr(os, "getuid"):  # Windows: both places belong to the user's profile
        return ""
    target = Path(os.path.realpath(folder))
    if target.stat().st_uid != os.getuid():
        return f"{str(target)!r} belongs to another user; set UICTEST_CACHE to a folder of your own"
    above = dict.fromkeys((*folder.parents, *target.parents))
    reasons = (_why_unsafe_place(place, above=place in above) for place in (target, folder, *above))
    return next((reason for reason in reasons if reason), "")


def is_trusted(status: os.stat_result) -> bool:
    """Return whether a file belongs to this user and nobody else can write it."""
    if not hasattr(os, "getuid"):
        return True
    return status.st_uid == os.getuid() and not status.st_mode & _BY_OTHERS


def _why_unsafe_place(place: Path, *, above: bool) -> str:
    status = place.lstat()
    if status.st_uid not in (os.getuid(), _SYSTEM):
        return f"{str(place)!r} belongs to another user; set UICTEST_CACHE to a folder of your own"
    is_protected = stat.S_ISLNK(status.st_mode) or (above and status.st_mode & stat.S_ISVTX)
    if status.st_mode & _BY_OTHERS and not is_protected:
        return f"others can write {str(place)!r}, and what is cached is executed; `chmod go-w` it"
    return ""


def _user_cache() -> Path:
    if override := os.environ.get("UICTEST_CACHE"):
        return Path(override)
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", "~")).expanduser() / "uictest" / "cache"
    if sys.platform == "darwin":
        return Path("~/Library/Caches/uictest").expanduser()
    return Path(os.environ.get("XDG_CACHE_HOME") or "~/.cache").expanduser() / "uictest"
