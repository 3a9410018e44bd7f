"""Where things are kept that can be made again: the compiled rig, what pages are made of."""

import os
import stat
import sys
import tempfile
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path


def user_cache(name: str) -> Path | None:
    """Return a folder of that name, which exists and which this user alone writes; None if there can be none.

    It lies in the user's cache or, where that cannot be written, in a temporary folder of the user.
    """
    return next((root / name for root in _roots() if _is_writable(root / name)), None)


def _roots() -> Iterator[Path]:
    with suppress(RuntimeError):  # a user without a home
        yield _user_cache()
    among_others = Path(tempfile.gettempdir()) / f"uictest-{_user()}"
    if _is_private(among_others):
        yield among_others


def _is_private(folder: Path) -> bool:
    """Whether a folder in a place open to all users, made if need be, is ours and written by us alone.

    Code is kept there: who can write it could have us run anything.
    """
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        found = folder.lstat()
    except OSError:
        return False
    if not hasattr(os, "getuid"):  # where there are no such users, everybody has a temporary folder
        return True
    others = stat.S_IWGRP | stat.S_IWOTH
    return stat.S_ISDIR(found.st_mode) and found.st_uid == os.getuid() and not found.st_mode & others


def _user_cache() -> Path:
    if override := os.environ.get("UICTEST_CACHE"):
        return Path(override)
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", "~")).expanduser() / "uictest" / "cache"
    if sys.platform == "darwin":
        return Path("~/Library/Caches/uictest").expanduser()
    return Path(os.environ.get("XDG_CACHE_HOME") or "~/.cache").expanduser() / "uictest"


def _user() -> str:
    return str(os.getuid()) if hasattr(os, "getuid") else os.environ.get("USERNAME", "user")


def _is_writable(folder: Path) -> bool:
    try:
        folder.mkdir(parents=True, exist_ok=True, mode=0o700)
        with tempfile.TemporaryFile(dir=folder):
            return True
    except OSError:
        return False
