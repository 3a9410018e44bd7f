"""Files of the cache: a digest of inputs and content, then the content."""

from __future__ import annotations

import contextlib
import hashlib
import logging
import os
import stat
import tempfile
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from uictest.user_cache.ownership import is_trusted, why_unsafe
from uictest.user_cache.places import make_private, roots

_DIGEST_SIZE = hashlib.sha256().digest_size
# A FIFO must not block the reader until somebody writes; Windows has neither it nor links that need care.
_READ_ONLY = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_NOFOLLOW", 0)


def read(kind: str, inputs: bytes) -> bytes | None:
    """Return the content kept under these names; None where there is none that is intact.

    Args:
        kind: what it is, part of the file's name.
        inputs: everything that the content was made of: sources, versions, options, the processor.
    """
    for folder in _safe_folders(make=False):
        with contextlib.suppress(OSError):
            kept = _bytes_of(folder / _name(kind, inputs))
            content = kept[_DIGEST_SIZE:]
            if kept[:_DIGEST_SIZE] == _digest(inputs, content):
                return content
    return None


def write(kind: str, inputs: bytes, content: bytes) -> None:
    """Keep content for :func:`read`, in the first folder that takes it; where none does, warn once."""
    for folder in _safe_folders(make=True):
        try:
            _replace(folder / _name(kind, inputs), _digest(inputs, content) + content)
        except OSError as error:
            _warn(f"the cache {str(folder)!r} cannot be written ({error.strerror})")
        else:
            return
    _warn("nothing is cached, each run compiles anew; set UICTEST_CACHE to a folder that you alone can write")


def _safe_folders(*, make: bool) -> Iterator[Path]:
    """Yield the folders of the cache that exist, or that are made now, and that this user alone can write."""
    for root in roots():
        try:
            if make:
                make_private(root)
            reason = why_unsafe(root)
        except OSError:  # a home that is missing or read-only: the next root does
            continue
        if reason:
            _warn(f"the cache {str(root)!r} is not used: {reason}")
        else:
            yield Path(os.path.realpath(root))


def _name(kind: str, inputs: bytes) -> str:
    return f"{kind}-{hashlib.sha256(inputs).hexdigest()[:20]}"


def _digest(inputs: bytes, content: bytes) -> bytes:
    return hashlib.sha256(hashlib.sha256(inputs).digest() + content).digest()


def _bytes_of(path: Path) -> bytes:
    """Return the bytes of an ordinary file that this user alone can write. Raises OSError."""
    with os.fdopen(os.open(path, _READ_ONLY | getattr(os, "O_BINARY", 0)), "rb") as file:
        status = os.fstat(file.fileno())
        if not (stat.S_ISREG(status.st_mode) and is_trusted(status)):
            raise PermissionError(f"{path} is not a file of this user alone")
        return file.read()


def _replace(path: Path, content: bytes) -> None:
    """Write a file whole or not at all. A crash may leave any bytes: the digest tells."""
    descriptor, temporary = tempfile.mkstemp(prefix=".partial-", dir=path.parent)
    try:
        with os.fdopen(descriptor, "wb") as file:
            file.write(content)
        Path(temporary).replace(path)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise


@cache
def _warn(text: str) -> None:
    """Write a warning to stderr; each text once."""
    logging.getLogger(__name__).warning("uictest: %s", text)
