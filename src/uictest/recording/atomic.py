"""Atomic writing: a file appears whole or not at all, written beside its place and renamed into it."""

from __future__ import annotations

import contextlib
import os
import secrets
from collections.abc import Iterator
from pathlib import Path


@contextlib.contextmanager
def atomic_path(path: Path, *, private: bool = False) -> Iterator[Path]:
    """Yield a temporary path in the folder of `path`, and rename it to `path` if the block succeeds.

    The temporary path is an empty file with the suffix of `path`, which some writers depend on; a `private`
    one only this user can read and write. If the block raises, the temporary file is removed, a file at
    `path` stays as it was, and the exception propagates.

    Raises:
        OSError: the folder is missing, full or not writable; it names `path`, not the temporary one.

    """
    temporary = _neighbour(path)
    with _errors_about(path, instead_of=temporary):
        temporary.touch(mode=0o600 if private else 0o666, exist_ok=False)
        try:
            yield temporary
            _flush_to_disk(temporary)
            temporary.replace(path)
        except BaseException:
            temporary.unlink(missing_ok=True)
            raise


def write_bytes_atomic(path: Path, content: bytes) -> None:
    """Write `content` to `path`, whole or not at all. Raises OSError."""
    with atomic_path(path) as temporary:
        temporary.write_bytes(content)


def write_text_atomic(path: Path, content: str) -> None:
    """Write `content` to `path` as UTF-8, line ends untouched, whole or not at all. Raises OSError."""
    write_bytes_atomic(path, content.encode("utf-8"))


@contextlib.contextmanager
def _errors_about(path: Path, instead_of: Path) -> Iterator[None]:
    """Replace the temporary file by `path` in errors about it, and in errors that name no file."""
    try:
        yield
    except OSError as error:
        if error.errno is None or error.filename not in (None, str(instead_of)):
            raise
        raise OSError(error.errno, error.strerror, str(path)) from error


def _neighbour(path: Path) -> Path:
    # In the same folder, hence on the same file system: only there is a rename atomic. The name does not hold
    # the final one, which may already be as long as names can be; tempfile would make it private to the user.
    return path.with_name(f".partial-{secrets.token_hex(8)}{path.suffix}")


def _flush_to_disk(path: Path) -> None:
    with path.open("rb+") as file:
        os.fsync(file.fileno())
