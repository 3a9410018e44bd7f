"""Turns: what is cached is made by one process, and the others wait for it instead of making it as well."""

from __future__ import annotations

import contextlib
import os
import sys
import time
from collections.abc import Iterator
from pathlib import Path

from uictest.user_cache.files import name_of, safe_folders

PATIENCE = 300.0
"""Longest wait, s; chosen: some ten times what a slow machine takes to compile one entry of the rig."""
_PAUSE = 0.05  # s between two attempts


@contextlib.contextmanager
def turn(kind: str, inputs: bytes) -> Iterator[None]:
    """Wait until no other process makes the content of these inputs, and let others wait until the end.

    Whoever has waited should :func:`read` again. A process that ends, however it ends, lets the next one in.
    Nobody waits where no folder can be written, on Windows, and on network shares without locks; nor longer
    than :data:`PATIENCE`, for a process that was stopped.

    Args:
        kind: kind of content, as for :func:`read`.
        inputs: everything that the content is made of, as for :func:`read`.
    """
    with contextlib.ExitStack() as held:
        for folder in safe_folders(make=True):
            with contextlib.suppress(OSError):
                held.enter_context(_locked(folder / f"{name_of(kind, inputs)}.lock"))
                break
        yield


if sys.platform == "win32":

    @contextlib.contextmanager
    def _locked(path: Path) -> Iterator[None]:
        yield

else:
    import fcntl

    @contextlib.contextmanager
    def _locked(path: Path) -> Iterator[None]:
        """Hold the lock of a file, which exists only meanwhile. Raises OSError where it cannot be had."""
        descriptor = _locked_descriptor(path)
        try:
            yield
        finally:
            with contextlib.suppress(OSError):
                path.unlink()
            os.close(descriptor)

    def _locked_descriptor(path: Path) -> int:
        latest = time.monotonic() + PATIENCE
        while True:
            descriptor = os.open(path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW, 0o600)
            try:
                _lock(descriptor, latest)
            except BaseException:
                os.close(descriptor)
                raise
            if _is_at(path, descriptor):
                return descriptor
            os.close(descriptor)  # its last holder has just removed it

    def _lock(descriptor: int, latest: float) -> None:
        """Lock a file as soon as nobody else does. Raises TimeoutError after the latest moment."""
        while True:
            try:
                return fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                if time.monotonic() > latest:
                    raise TimeoutError from None
                time.sleep(_PAUSE)

    def _is_at(path: Path, descriptor: int) -> bool:
        try:
            return os.path.samestat(path.stat(), os.fstat(descriptor))
        except FileNotFoundError:
            return False
