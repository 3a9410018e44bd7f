"""Turns: what is cached is made by one process, and the others wait for it instead of making it as well."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator

from uictest.core import files
from uictest.core.user_cache.files import name_of, safe_folders

PATIENCE = 300.0
"""Longest wait, s; chosen: some ten times what a slow machine takes to compile one entry of the rig."""


@contextlib.contextmanager
def turn(kind: str, inputs: bytes) -> Iterator[None]:
    """Wait until no other process makes the content of these inputs, and let others wait until the end.

    Whoever has waited should :func:`read` again. A process that ends, however it ends, lets the next one in.
    Nobody waits where no folder can be written, and on network shares without locks; nor longer
    than :data:`PATIENCE`, for a process that was stopped.

    Args:
        kind: kind of content, as for :func:`read`.
        inputs: everything that the content is made of, as for :func:`read`.
    """
    with contextlib.ExitStack() as held:
        for folder in safe_folders(make=True):
            name = f"{name_of(kind, inputs)}.lock"
            with contextlib.suppress(OSError, files.FolderInUseError):
                held.enter_context(files.FolderLock(folder, name=name, patience=PATIENCE))
                break
        yield
