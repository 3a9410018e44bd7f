"""Temporary folders: made private to the user by `tempfile`, removed without following links."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def temporary_folder() -> Iterator[Path]:
    """Lend a folder that is removed at the end of the block. Raises OSError."""
    with tempfile.TemporaryDirectory(prefix="uictest-") as folder:
        yield Path(folder)


def new_temporary_folder(kind: str) -> Path:
    """Return a new folder, which `remove_temporary_folder` removes. Raises OSError."""
    return Path(tempfile.mkdtemp(prefix=f"uictest-{kind}-"))


def remove_temporary_folder(folder: Path) -> None:
    """Remove a folder of `new_temporary_folder` as far as possible."""
    shutil.rmtree(folder, ignore_errors=True)
