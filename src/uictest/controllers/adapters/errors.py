"""Why a controller cannot be loaded, or what it failed in."""

from typing import Final

_LONGEST: Final = 2000
"""Characters of what is told about a failure; chosen: a reason stands in every report."""


class ControllerError(Exception):
    """A controller cannot be loaded, or failed; the message says why."""

    def __init__(self, message: str) -> None:
        more = " ..." if len(message) > _LONGEST else ""
        super().__init__(message[:_LONGEST] + more)


class OnlyOneError(ControllerError):
    """A controller cannot be loaded because one of its kind is open, and a process can have only one."""
