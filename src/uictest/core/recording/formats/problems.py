"""Errors and limits of reading and writing recordings."""

from __future__ import annotations

import importlib
import math
from collections.abc import Iterable
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


LARGEST_FILE = 2**30
"""bytes"""

MOST_VALUES = 50_000_000
"""Values of all channels of a file together: 400 MB."""

MOST_CHANNELS = 20_000

READING_SECONDS = 120.0
"""Time after which reading is aborted."""

READING_MEMORY = 6 * 2**30
"""Address space of the process that reads, bytes."""


def check_size(shapes: Iterable[tuple[int, ...]]) -> None:
    """Raise UnreadableError where the channels that a file declares are too many or too long together."""
    sizes = [math.prod(shape) for shape in shapes]
    if len(sizes) > MOST_CHANNELS:
        raise UnreadableError(f"{len(sizes)} channels; at most {MOST_CHANNELS} are read")
    if any(size < 0 for size in sizes) or sum(sizes) > MOST_VALUES:
        raise UnreadableError(f"{sum(sizes)} values; at most {MOST_VALUES} are read")
