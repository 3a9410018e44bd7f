"""Digests of the data that ships with the package."""

import hashlib
from collections.abc import Iterator
from pathlib import Path
from typing import Final

_PACKAGE: Final = Path(__file__).parents[1]
_FOLDERS: Final = ("plans/library", "selftest/stops", "selftest/record", "plans/templates")
"""Where the parts, criteria, known stops and first files of users lie."""
_OF_PYTHON: Final = "__pycache__"


def data_digests(package: Path = _PACKAGE) -> dict[str, str]:
    """Return the SHA-256 of every shipped data file below a package, by its path."""
    return {
        path.relative_to(package).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
        for folder in _FOLDERS
        for path in _files(package / folder)
    }


def _files(folder: Path) -> Iterator[Path]:
    """Yield the files below a folder, without what Python leaves there and what editors hide."""
    for path in sorted(folder.rglob("*"), key=Path.as_posix):
        hidden = any(part.startswith(".") or part == _OF_PYTHON for part in path.relative_to(folder).parts)
        if path.is_file() and not hidden:
            yield path
