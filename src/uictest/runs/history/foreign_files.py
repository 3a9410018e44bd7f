"""Files below a folder of runs, which may be damaged or not ours, and never be read without end."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Final

from pydantic import ValidationError

_LARGEST: Final = 32 << 20
"""Size of the largest file that is read, bytes."""
_SHOWN: Final = 80
"""Characters that are shown of what a file holds."""


class UnreadableError(Exception):
    """Why a folder cannot be read as a run."""


def json_object(path: Path) -> dict[str, Any]:
    """Return the object in a JSON file. Raises UnreadableError, OSError."""
    try:
        content = json.loads(bytes_of(path))
    except (ValueError, RecursionError) as error:
        raise UnreadableError(f"{path.name} is damaged: {error}") from error
    if not isinstance(content, dict):
        raise UnreadableError(f"{path.name} is damaged: expected an object")
    return content


def bytes_of(path: Path) -> bytes:
    """Return the content of a regular file that is not too large. Raises UnreadableError, OSError.

    Anything else could block for ever, or have no end.
    """
    if not path.is_file():
        raise UnreadableError(f"{path.name} is no file")
    if (size := path.stat().st_size) > _LARGEST:
        raise UnreadableError(f"{path.name} of {size >> 20} MB is not read")
    return path.read_bytes()


def exists(path: Path) -> bool:
    """Return whether there is anything of this name, be it a link that leads nowhere."""
    return path.is_symlink() or path.exists()


def first_problem(error: ValidationError) -> str:
    """Return the first problem of content that is not what was expected, with its place."""
    problem = error.errors(include_url=False, include_input=False)[0]
    place = ".".join(map(str, problem["loc"]))
    return f"{place}: {problem['msg']}" if place else problem["msg"]


def shown(value: object) -> str:
    """Return what was found, shortened."""
    return repr(value)[:_SHOWN]
