"""Pages at places where somebody else may keep a page: recognised by a mark that they hold."""

from __future__ import annotations

from pathlib import Path


def may_replace(path: Path, mark: str) -> bool:
    """Return whether a page may be written here: there is none yet, or one with this mark.

    A template writes the mark as the attribute `data-document`. Raises OSError.
    """
    if path.is_symlink():
        return False
    if not path.exists():
        return True
    return path.is_file() and f'data-document="{mark}"'.encode() in path.read_bytes()
