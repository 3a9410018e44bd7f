"""Why a controller cannot be loaded, or what it failed in."""

import hashlib
from pathlib import Path
from typing import Final

_LONGEST: Final = 2000
"""Characters of what is told about a failure; chosen: a reason stands in every report."""


class ControllerError(Exception):
    """A controller cannot be loaded, or failed; the message says why.

    `output` is what it printed in its stop, where that is kept.
    """

    output = ""

    def __init__(self, message: str) -> None:
        more = " ..." if len(message) > _LONGEST else ""
        super().__init__(message[:_LONGEST] + more)


class OnlyOneError(ControllerError):
    """A controller cannot be loaded because one of its kind is open, and a process can have only one."""


def unchanged_content(path: Path, sha256: str) -> bytes:
    """Return the content of a program's file. Raises ControllerError where it is another than was read."""
    content = path.read_bytes()
    if hashlib.sha256(content).hexdigest() != sha256:
        raise ControllerError(f"{path.name} has changed since the scenario was read")
    return content
