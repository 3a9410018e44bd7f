"""The user's cache: identified compensations, compiled templates and packed scripts, kept for later runs.

Cached content is executed or becomes part of a page. It is therefore read from and written to folders that
only this user can write or replace, and a file is used only if it is intact and was made from the same
inputs: it begins with a digest of inputs and content. All access to these folders goes through this module.
"""

from __future__ import annotations

import contextlib
import hashlib
import logging
import os
import stat
import sys
import tempfile
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from uictest.core import files

_DIGEST_SIZE = hashlib.sha256().digest_size
_BY_OTHERS = stat.S_IWGRP | stat.S_IWOTH
_SYSTEM = 0
"""User id of the system's administrator."""


def read(kind: str, inputs: bytes) -> bytes | None:
    """Return the cached content of these inputs; None if there is none that is intact.

    Args:
        kind: kind of content, part of the file's name.
        inputs: everything that the content was made of: sources, versions, options, the processor.
    """
    for folder in safe_folders(make=False):
        with contextlib.suppress(OSError):
            cached = _bytes_of(folder / name_of(kind, inputs))
            content = cached[_DIGEST_SIZE:]
            if cached[:_DIGEST_SIZE] == _digest_of_entry(inputs, content):
                return content
    return None


def write(kind: str, inputs: bytes, content: bytes) -> None:
    """Cache content for :func:`read` in the first writable folder; warn once if there is none."""
    for folder in safe_folders(make=True):
        try:
            files.write(
                folder, name_of(kind, inputs), _digest_of_entry(inputs, content) + content, private=True
            )
        except OSError as error:
            _warn_once(f"the cache {str(folder)!r} cannot be written ({error.strerror})")
        else:
            return
    _warn_once(
        "nothing is cached, so each run computes anew; set UICTEST_CACHE to a folder that only you can write"
    )


def safe_folders(*, make: bool) -> Iterator[Path]:
    """Yield the folders of the cache that only this user can write; `make` creates missing ones."""
    for root in roots():
        try:
            if make:
                files.make_folder(root, mode=0o700)
            reason = why_unsafe(root)
        except OSError:  # a home that is missing or read-only: try the next root
            continue
        if reason:
            _warn_once(f"the cache {str(root)!r} is not used: {reason}")
        else:
            yield Path(os.path.realpath(root))


def name_of(kind: str, inputs: bytes) -> str:
    """Return the name of the file that keeps the content of these inputs."""
    return f"{kind}-{hashlib.sha256(inputs).hexdigest()[:20]}"


def _digest_of_entry(inputs: bytes, content: bytes) -> bytes:
    return hashlib.sha256(hashlib.sha256(inputs).digest() + content).digest()


def _bytes_of(path: Path) -> bytes:
    """Return the bytes of a regular file that only this user can write. Raises OSError."""
    status = path.lstat()
    if not (stat.S_ISREG(status.st_mode) and is_trusted(status)):
        raise PermissionError(f"{path} is not a file of this user alone")
    return path.read_bytes()


@cache
def _warn_once(text: str) -> None:
    logging.getLogger(__name__).warning("uictest: %s", text)


def roots() -> Iterator[Path]:
    """Yield the folders of the cache, the best first; they need not exist."""
    with contextlib.suppress(RuntimeError):  # a user without a home
        yield _user_cache().absolute()
    user = os.getuid() if hasattr(os, "getuid") else os.environ.get("USERNAME", "user")
    with contextlib.suppress(FileNotFoundError):  # no temporary folder is writable
        yield Path(tempfile.gettempdir(), f"uictest-{user}").absolute()


def why_unsafe(folder: Path) -> str:
    """Return the way in which others could put files into a folder, and the remedy; empty if they cannot.

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
    reasons = (_why_unsafe_path(path, above=path in above) for path in (target, folder, *above))
    return next((reason for reason in reasons if reason), "")


def is_trusted(status: os.stat_result) -> bool:
    """Return whether a file belongs to this user and nobody else can write it."""
    if not hasattr(os, "getuid"):
        return True
    return status.st_uid == os.getuid() and not status.st_mode & _BY_OTHERS


def _why_unsafe_path(path: Path, *, above: bool) -> str:
    status = path.lstat()
    if status.st_uid not in (os.getuid(), _SYSTEM):
        return f"{str(path)!r} belongs to another user; set UICTEST_CACHE to a folder of your own"
    is_protected = stat.S_ISLNK(status.st_mode) or (above and status.st_mode & stat.S_ISVTX)
    if status.st_mode & _BY_OTHERS and not is_protected:
        return f"others can write {str(path)!r}, and what is cached is executed; `chmod go-w` it"
    return ""


def _user_cache() -> Path:
    if override := os.environ.get("UICTEST_CACHE"):
        return Path(override)
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", "~")).expanduser() / "uictest" / "cache"
    if sys.platform == "darwin":
        return Path("~/Library/Caches/uictest").expanduser()
    return Path(os.environ.get("XDG_CACHE_HOME") or "~/.cache").expanduser() / "uictest"
