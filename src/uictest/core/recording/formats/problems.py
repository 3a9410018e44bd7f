"""Errors of reading and writing recordings, and libraries that only some formats need."""

from __future__ import annotations

import importlib
from typing import Any


class UnreadableError(ValueError):
    """A file that cannot be read as a recording; the message says why."""


class MissingExtraError(Exception):
    """A format whose library is not installed; the message is the line that installs it."""


class ReadingInterruptedError(OSError):
    """Reading was interrupted by the machine, whatever the file contains: a full disk, a killed process."""


def required_module(module: str, extra: str) -> Any:
    """Return a module. Raises MissingExtraError with the line that installs it, as `uictest[extra]`."""
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        if error.name is None or error.name.partition(".")[0] != module.partition(".")[0]:
            raise
        raise MissingExtraError(f"{module} is not installed: pip install 'uictest[{extra}]'") from error
