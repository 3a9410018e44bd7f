"""What stands in the way of reading or writing a measurement file."""

from __future__ import annotations


class UnreadableError(ValueError):
    """A file that cannot be read as a measurement; the message says why."""


class MissingExtraError(Exception):
    """A format whose library is not installed; the message is the line that installs it."""


class BrokenOffError(OSError):
    """Reading was broken off by the machine, whatever the file holds: a full disk, a process killed."""
