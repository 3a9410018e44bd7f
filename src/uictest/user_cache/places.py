"""Folders of the cache: in the user's cache, else in a temporary folder of the user."""

from __future__ import annotations

import contextlib
import os
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path


def roots() -> Iterator[Path]:
    """Yield the folders of the cache, the best first; they need not exist."""
    with contextlib.suppress(RuntimeError):  # a user without a home
        yield _user_cache().absolute()
    user = os.getuid() if hasattr(os, "getuid") else os.environ.get("USERNAME", "user")
    with contextlib.suppress(FileNotFoundError):  # no temporary folder is writable
        yield Path(tempfile.gettempdir(), f"uictest-{user}").absolute()


def make_private(folder: Path) -> None:
    """Create a folder and its missing parents for this user alone. Raises OSError."""
    for place in reversed([place for place in (folder, *folder.parents) if not place.exists()]):
        place.mkdir(mode=0o700, exist_ok=True)


def _user_cache() -> Path:
    if override := os.environ.get("UICTEST_CACHE"):
        return Path(override)
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", "~")).expanduser() / "uictest" / "cache"
    if sys.platform == "darwin":
        return Path("~/Library/Caches/uictest").expanduser()
    return Path(os.environ.get("XDG_CACHE_HOME") or "~/.cache").expanduser() / "uictest"
